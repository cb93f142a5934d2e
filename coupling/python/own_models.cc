// Models whose stress a function of Python gives.
#include "continuum/own_models.h"

#include <fmt/format.h>

#include <stdexcept>

#include "continuum/settings.h"
#include "coupling/base/signals.h"
#include "coupling/python/bindings.h"

namespace grainfield::python {
namespace {

/// A function that threads without Python's lock may hold and let go.
std::shared_ptr<py::function> kept(const py::function& function) {
  return {new py::function(function), [](py::function* held) {
            const py::gil_scoped_acquire acquired;
            delete held;
          }};
}

py::array_t<double> copied(const Eigen::MatrixXd& values) {
  py::array_t<double> out({values.rows(), values.cols()});
  auto to = out.mutable_unchecked<2>();
  for (Eigen::Index r = 0; r < values.rows(); ++r)
    for (Eigen::Index c = 0; c < values.cols(); ++c) to(r, c) = values(r, c);
  return out;
}

class OwnModel : public continuum::Model {
 public:
  OwnModel(std::shared_ptr<py::function> stress, continuum::Settings settings)
      : stress_(std::move(stress)), settings_(std::move(settings)) {}

  /// Calls the function with points and settings. Throws std::runtime_error with the text of what
  /// it raises; coupling::Interrupted for Ctrl-C.
  continuum::Stresses stress(const continuum::Points& points) override {
    const py::gil_scoped_acquire acquired;
    try {
      return matrix_of((*stress_)(copied(points), settings_), "stresses");
    } catch (const py::error_already_set& error) {
      if (error.matches(PyExc_KeyboardInterrupt)) throw coupling::Interrupted("stopped");
      throw std::runtime_error(py::str(error.value()).cast<std::string>());
    }
  }

 private:
  std::shared_ptr<py::function> stress_;
  continuum::Settings settings_;
};

continuum::Parameter parameter_of(const py::dict& given) {
  const auto least = given["least"].cast<double>(), most = given["most"].cast<double>();
  continuum::Parameter out = continuum::number(
      given["name"].cast<std::string>(), given["unit"].cast<std::string>(),
      given["meaning"].cast<std::string>(), "", given["default"].cast<double>(), least, most);
  return given["free"].cast<bool>() ? continuum::may_be_free(out, least, most) : out;
}

/// `stress`: takes points (n, dim), m, and all settings as texts, and returns (n, 3) or (n, 6).
void add_own_model(const std::string& name, const std::string& summary, int dim,
                   const std::vector<py::dict>& parameters, const py::function& stress) {
  continuum::ModelInfo info;
  info.name = name;
  info.summary = summary;
  info.dim = dim;
  for (const py::dict& parameter : parameters) info.parameters.push_back(parameter_of(parameter));
  const auto held = kept(stress);
  const Released alone(true);  // no fit or comparison goes on
  info.make = [held](const continuum::Settings& settings) {
    return std::make_unique<OwnModel>(held, settings);
  };
  continuum::add_own_model(std::move(info));
}

}  // namespace

void add_own_models(py::module_& module) {
  module.def("add_own_model", add_own_model, py::kw_only(), py::arg("name"), py::arg("summary"),
             py::arg("dim"), py::arg("parameters"), py::arg("stress"));
}

}  // namespace grainfield::python
