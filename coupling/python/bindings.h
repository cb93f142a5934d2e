// The C++ half of the Python module: what its files share. It adds nothing: every function calls
// the one that the command of the same name calls.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "coupling/base/field.h"
#include "coupling/tasks/average_task.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::python {

namespace py = pybind11;

/// A state in memory. Never changed: arrays on it and averages of it may last as long as they like.
struct Packing {
  std::shared_ptr<const dem::Snapshot> state;
  std::vector<std::string> doubts{};  ///< of arrays: what does not show in the state
};
struct HeldField {
  std::shared_ptr<const coupling::Field> field;
};

/// While it lives, other threads of Python run; and, with `files`, no other call of the module
/// reads or writes HDF5, which is not built for threads. No Python object may be touched meanwhile.
/// Throws std::runtime_error, with `files`, while a run goes on.
class Released {
 public:
  explicit Released(bool files);

 private:
  py::gil_scoped_release released_;
  std::unique_lock<std::mutex> files_;
};

/// While it lives, a run goes on in this process. Throws std::runtime_error while another does.
class OneRun {
 public:
  OneRun();
  ~OneRun();
  OneRun(const OneRun&) = delete;
  OneRun& operator=(const OneRun&) = delete;
};

/// A snapshot as a user of the module names it: in memory, or "FILE.h5[:GROUP]".
using Source = std::variant<std::string, Packing>;
/// Those of a list, files without a group opened up. Throws as parse_snapshot_names.
std::vector<coupling::SnapshotName> names_of(const std::vector<Source>& sources);
/// Some of them are in files.
bool in_files(const std::vector<Source>& sources);

/// A read-only array on the memory of `owner`, which it keeps alive. `strides` in bytes.
template <class T>
py::array view(const T* first, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               const py::handle& owner) {
  py::array out = shape.front() == 0 ? py::array(py::dtype::of<T>(), shape)
                                     : py::array(py::dtype::of<T>(), shape, strides, first, owner);
  out.attr("setflags")(py::arg("write") = false);
  return out;
}
py::array view(const Eigen::VectorXd& values, const py::handle& owner);
py::array view(const Eigen::MatrixXd& values, const py::handle& owner);

/// A copy of an array of numbers as a matrix. Throws std::invalid_argument naming `what` unless it
/// has two axes.
Eigen::MatrixXd matrix_of(const py::handle& array, const std::string& what);
Eigen::VectorXd vector_of(const py::handle& array, const std::string& what);
/// A new array that holds these numbers.
template <class T>
py::array_t<T> array_of(const std::vector<T>& values) {
  py::array_t<T> out(static_cast<py::ssize_t>(values.size()));
  std::copy(values.begin(), values.end(), out.mutable_data());
  return out;
}
py::array array_of(const Eigen::VectorXd& values);

HeldField held(coupling::Field field);

void add_data(py::module_& module);
void add_results(py::module_& module);
void add_commands(py::module_& module);
void add_engine(py::module_& module);
void add_own_models(py::module_& module);

}  // namespace grainfield::python
