// What compare and fit give: the C++ objects themselves, their numbers as arrays.
#include "coupling/compare/compare.h"
#include "coupling/fit/ensemble_fit.h"
#include "coupling/judge/words.h"
#include "coupling/python/bindings.h"
#include "coupling/result/judgement.h"
#include "coupling/result/profile_columns.h"
#include "coupling/tasks/compare_task.h"
#include "coupling/tasks/fit_task.h"

namespace grainfield::python {
namespace {

using coupling::Comparison;
using coupling::Fit;
using coupling::FittedParameter;
using coupling::JudgedModel;
using coupling::Judgement;

void add_judgement(py::module_& module) {
  py::class_<JudgedModel>(module, "JudgedModel",
                          "A model of a judgement; verdict.json has the same under these names.")
      .def_readonly("name", &JudgedModel::name)
      .def_readonly("label", &JudgedModel::label)
      .def_readonly("equations", &JudgedModel::equations)
      .def_readonly("free", &JudgedModel::free)
      .def_readonly("description", &JudgedModel::description)
      .def_readonly("misfit", &JudgedModel::misfit)
      .def_readonly("chance", &JudgedModel::chance)
      .def_readonly("values", &JudgedModel::values)
      .def_readonly("relative_l2", &JudgedModel::rel_l2)
      .def_readonly("score", &JudgedModel::score)
      .def_readonly("behind", &JudgedModel::behind)
      .def_readonly("behind_error", &JudgedModel::behind_error)
      .def_readonly("heights_behind", &JudgedModel::heights_behind)
      .def_readonly("heights_error", &JudgedModel::heights_error)
      .def_readonly("aic_behind", &JudgedModel::aic_behind)
      .def_property_readonly(
          "family", [](const JudgedModel& m) { return m.family.empty() ? m.name : m.family; })
      .def_property_readonly("distinguishable", &JudgedModel::distinguishable_text)
      .def_property_readonly("agrees", [](const JudgedModel& m) { return text_of(m.agrees()); })
      .def_property_readonly("supported",
                             [](const JudgedModel& m) { return text_of(m.supported()); })
      .def_property_readonly("realizations_needed",
                             [](const JudgedModel& m) { return m.power.realizations; })
      .def_property_readonly("realizations_least",
                             [](const JudgedModel& m) { return m.power.least; })
      .def_property_readonly("realizations_most", [](const JudgedModel& m) { return m.power.most; })
      .def("__repr__", [](const JudgedModel& m) {
        return "<JudgedModel " + m.name + ": supported " + text_of(m.supported()) + ">";
      });
  py::class_<coupling::JudgementTable>(module, "JudgementTable")
      .def_readonly("header", &coupling::JudgementTable::header)
      .def_readonly("rows", &coupling::JudgementTable::rows)
      .def_readonly("note", &coupling::JudgementTable::note);
  py::class_<Judgement>(module, "Judgement")
      .def_readonly("models", &Judgement::models)
      .def_readonly("best", &Judgement::best)
      .def_readonly("equations", &Judgement::equations)
      .def_readonly("rival", &Judgement::rival)
      .def_readonly("realizations", &Judgement::realizations)
      .def_readonly("doubts", &Judgement::doubts)
      .def_property_readonly("distinguishable",
                             [](const Judgement& j) { return text_of(j.distinguishable); })
      .def_property_readonly(
          "position",
          [](const Judgement& j) { return std::pair(j.position.value, j.position.error); })
      .def_property_readonly(
          "families", [](const Judgement& j) { return std::pair(j.position.from, j.position.to); })
      .def("headlines", coupling::headlines)
      .def("agreement", coupling::agreement_line)
      .def("sentence", coupling::sentence)
      .def("notes", coupling::note_lines)
      .def("table", coupling::table_of)
      .def("power", coupling::power_table)
      .def("text", coupling::judgement_text)
      .def("latex", coupling::judgement_latex)
      .def("json", coupling::judgement_json);
}

void add_fit(py::module_& module) {
  py::class_<FittedParameter>(module, "FittedParameter", "A constant with its errors.")
      .def_property_readonly("name", [](const FittedParameter& p) { return p.parameter.name; })
      .def_property_readonly("unit", [](const FittedParameter& p) { return p.parameter.unit; })
      .def_property_readonly("meaning",
                             [](const FittedParameter& p) { return p.parameter.meaning; })
      .def_readonly("value", &FittedParameter::value)
      .def_readonly("error", &FittedParameter::error)
      .def_readonly("low", &FittedParameter::low)
      .def_readonly("high", &FittedParameter::high)
      .def_readonly("covariance_error", &FittedParameter::covariance_error)
      .def_readonly("bootstrap_error", &FittedParameter::bootstrap_error)
      .def_readonly("jackknife_error", &FittedParameter::jackknife_error)
      .def_readonly("at_bound", &FittedParameter::at_bound)
      .def_readonly("determined", &FittedParameter::determined)
      .def("__repr__", [](const FittedParameter& p) {
        return "<" + p.parameter.name + " = " + coupling::with_error(p.value, p.error) +
               (p.parameter.unit == "-" ? "" : " " + p.parameter.unit) + ">";
      });
  py::class_<Fit>(module, "Fit", "A fitted model.")
      .def_readonly("name", &Fit::name)
      .def_readonly("label", &Fit::label)
      .def_readonly("equations", &Fit::equations)
      .def_readonly("parameters", &Fit::parameters)
      .def_readonly("misfit", &Fit::misfit)
      .def_readonly("dof", &Fit::dof)
      .def_readonly("chi2_per_dof", &Fit::chi2_per_dof)
      .def_readonly("chance", &Fit::chance)
      .def_readonly("rel_l2", &Fit::rel_l2)
      .def_readonly("converged", &Fit::converged)
      .def_readonly("note", &Fit::note)
      .def_readonly("turning_signs", &Fit::turning_signs)
      .def_property_readonly(
          "correlation",
          [](const py::object& self) { return view(self.cast<const Fit&>().correlation, self); })
      .def("__repr__", [](const Fit& f) { return "<Fit of " + f.name + ">"; });
}

// Notes, the profile's name of each row, and (name, unit, values) of each column.
py::tuple profiles_of(const Comparison& comparison) {
  coupling::ProfileColumns table = coupling::profile_columns(comparison);
  py::list columns;
  for (const coupling::ProfileColumn& column : table.columns) {
    columns.append(py::make_tuple(column.name, column.unit, array_of(column.values)));
  }
  return py::make_tuple(table.notes, table.profile, columns);
}

py::dict measures_of(const Comparison& comparison) {
  py::dict out;
  for (const coupling::ModelComparison& model : comparison.results) {
    py::dict one;
    one["rel_l2"] = model.overall.rel_l2;
    one["max"] = model.overall.largest;
    one["chi2_per_dof"] = model.overall.chi2_per_dof;
    one["chance"] = model.overall.chance;
    one["dof"] = model.overall.dof;
    out[py::str(model.key)] = one;
  }
  return out;
}

// What both outcomes have.
template <class Outcome>
void add_outcome(py::class_<Outcome>& outcome) {
  outcome.def_readonly("summary", &Outcome::summary)
      .def_readonly("lacks", &Outcome::lacks)
      .def_readonly("carried", &Outcome::carried)
      .def_readonly("measured", &Outcome::measured)
      .def_property_readonly(
          "judgement", [](const Outcome& o) -> const Judgement& { return o.comparison.judgement; })
      .def("profiles", [](const Outcome& o) { return profiles_of(o.comparison); });
}

}  // namespace

void add_results(py::module_& module) {
  add_judgement(module);
  add_fit(module);
  py::class_<coupling::CompareOutcome> compared(module, "CompareOutcome");
  add_outcome(compared);
  compared
      .def_property_readonly(
          "doubts", [](const coupling::CompareOutcome& o) { return o.comparison.judgement.doubts; })
      .def("measures", [](const coupling::CompareOutcome& o) { return measures_of(o.comparison); });
  py::class_<coupling::FitOutcome> fitted(module, "FitOutcome");
  add_outcome(fitted);
  fitted.def_readonly("packings", &coupling::FitOutcome::packings)
      .def_readonly("note", &coupling::FitOutcome::note)
      .def_readonly("warnings", &coupling::FitOutcome::warnings)
      .def_readonly("coverage", &coupling::FitOutcome::coverage)
      .def_property_readonly("fits", [](const coupling::FitOutcome& o) -> const std::vector<Fit>& {
        return o.fits->fits;
      });
}

}  // namespace grainfield::python
