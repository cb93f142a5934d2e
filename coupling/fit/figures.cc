#include <algorithm>

#include "coupling/fit/fit_keys.h"
#include "coupling/fit/heap_models.h"
#include "coupling/fit/layer_models.h"

namespace grainfield::coupling {
namespace {

// Each name once, with the models that have it.
void add_constant(const std::string& name, const std::string& unit, const std::string& meaning,
                  const std::string& model, std::vector<SummaryKey>& out) {
  const std::string pattern = "fit.*." + name;
  const auto known = std::find_if(out.begin(), out.end(),
                                  [&](const SummaryKey& key) { return key.pattern == pattern; });
  if (known != out.end()) {
    known->meaning += ", " + model;
  } else {
    out.push_back({pattern, unit, meaning + "; of " + model});
  }
}

void add_constants(std::vector<SummaryKey>& out) {
  std::vector<RegistryEntry> models = heap_entries({});
  for (RegistryEntry& model : layer_entries()) models.push_back(std::move(model));
  for (const RegistryEntry& model : models) {
    for (const FitParameter& p : model.parameters) {
      add_constant(p.name, p.unit, p.meaning, model.name, out);
    }
  }
  for (const continuum::ModelInfo& info : continuum::registry()) {
    if (info.dim == 3) continue;
    for (const continuum::Parameter& p : info.parameters) {
      if (p.free)
        add_constant(p.name, p.unit == "m" ? "h" : p.unit, p.meaning,
                     info.name + ":" + p.name + "=free", out);
    }
  }
}

}  // namespace

std::vector<SummaryKey> figures_of_fits() {
  std::vector<SummaryKey> out{
      {"fit.values", "-", "stress values that are fitted, all components and heights"},
      {"fit.slope_deg", "deg", "mean slope of the piles: the models' slope and friction angle"},
      {"fit.left_deg", "deg", "slope of the left flank, for models that take the flanks apart"},
      {"fit.right_deg", "deg", "the same on the right"},
      {"fit.friction_deg", "deg", "friction angle of these models"},
      {"fit.weight_over_wedge", "-",
       "weight of the heaps over that of wedges of their height and slopes: 1 for pointed heaps, "
       "more under round tops; not there where it is not known"},
      {"fit.weights", "text", "values, their working units and what is missing for errors"},
      {"fit.warnings", "text",
       "what makes the constants doubtful: unbalanced heaps, heights below the averaging width"},
      {"fit.*.*.error", "-",
       "error of the parameter that is quoted, in its unit: over realizations left out, below "
       "three from the covariance"},
      {"fit.*.*.covariance_error", "-",
       "by the covariance of the values, which the realizations show"},
      {"fit.*.*.jackknife_error", "-", "over realizations left out"},
      {"fit.*.*.bootstrap_error", "-", "from draws of the realizations"},
      {"fit.*.chi2_per_dof", "-",
       "misfit: squared difference over what the errors make of a true model's, 1 in the mean"},
      {"fit.*.chi2_chance", "-", "the misfit that a true model exceeds in 1 of 100 ensembles"},
      {"fit.*.rel_l2", "-", "|grains - model| / |grains|"},
      {"fit.*.note", "text", "what the reader must know of the fit: bounds, no convergence"},
      {"fit.*.cv_behind", "-",
       "squared difference on the realization left out less the nearest model's, over the square "
       "of "
       "the signal"},
      {"fit.*.cv_behind_error", "-", "its standard error over the realizations"},
      {"fit.*.heights_behind", "-", "the same on the height left out"},
      {"fit.*.heights_behind_error", "-", "its standard error over the realizations"},
      {"fit.*.aic_behind", "-",
       "of a single field with errors: chi2 + 2 x free numbers less the nearest model's; above 10 "
       "it "
       "counts"},
      {"fit.*.distinguishable", "text",
       "from the nearest model: yes: behind it by more than chance; no; reference: it is the "
       "nearest; "
       "unknown: no errors"},
      {"fit.*.agrees", "text", "yes: chi2_per_dof is within chi2_chance; no; unknown: no errors"},
      {"fit.*.supported", "text",
       "yes: it agrees and is not distinguishable from the nearest; no; unknown: no errors"},
      {"fit.*.branch", "text", "branch of Cantelaube's theory whose core angle is closest"},
      {"fit.*.flank_balance_x", "-",
       "flanks: a_xy - a_xx tan(slope), 0 in equilibrium along x; else a description, no field"},
      {"fit.*.flank_balance_y", "-",
       "flanks: a_yy - 1 - a_xy tan(slope), 0 in equilibrium along y"},
      {"fit.*.K", "-", "OSL: ratio of the normal stresses on the fixed axes (Roul 4.23)"},
      {"fit.*.tau_deg", "deg", "OSL: angle of the fixed axes (Roul 4.23)"},
      {"fe.*.constants_of", "text", "fitted model whose constants a finite-element solve took"},
      {"fe.*.note", "text", "why it was not solved; empty: it was"},
      {"fe.*.chi2_per_dof", "-", "of its field, on the fit's points with the fit's weights"},
      {"fe.*.rel_l2", "-", "|grains - it| / |grains|"},
      {"fe.*.from_closed_form", "-", "|it - fitted closed form| / |closed form|"},
  };
  add_constants(out);
  return out;
}

}  // namespace grainfield::coupling
