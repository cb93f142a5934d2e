// The module itself: its parts, and what becomes of exceptions.
#include "coupling/base/failure.h"
#include "coupling/base/signals.h"
#include "coupling/base/version.h"
#include "coupling/python/bindings.h"

namespace {

namespace py = pybind11;

// Exit code 2 is ValueError, 3 RuntimeError, with the text of the command line.
void translate(std::exception_ptr error) {
  if (!error) return;
  try {
    std::rethrow_exception(error);
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const py::error_already_set&) {
    throw;
  } catch (const std::bad_alloc&) {
    PyErr_NoMemory();
  } catch (...) {
    const auto failure = grainfield::coupling::failure_of(std::current_exception());
    PyObject* kind = PyExc_RuntimeError;
    if (failure.code == 2) kind = PyExc_ValueError;
    if (failure.code == grainfield::coupling::kExitStorage) kind = PyExc_OSError;
    if (failure.code == grainfield::coupling::kExitInterrupted) kind = PyExc_KeyboardInterrupt;
    PyErr_SetString(kind, failure.text.c_str());
  }
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "grainfield's C++ half; use the package grainfield";
  py::register_exception_translator(translate);
  module.attr("version") = grainfield::coupling::version_and_commit();
  grainfield::python::add_data(module);
  grainfield::python::add_results(module);
  grainfield::python::add_commands(module);
  grainfield::python::add_engine(module);
  grainfield::python::add_own_models(module);
}
