#include "coupling/fit/fit_keys.h"

#include <fmt/format.h>

#include <stdexcept>

#include "continuum/model.h"
#include "coupling/case/declare.h"
#include "coupling/fit/heap_models.h"
#include "coupling/fit/layer_models.h"
#include "coupling/fit/open_models.h"
#include "coupling/observe/setup.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(FitSetup, MEMBER)

namespace grainfield::coupling {
namespace {

// The words of fit.models, with the free constants of each.
OwnWords models_of_list(const std::vector<RegistryEntry>& list, ModelTextCheck check) {
  OwnWords out{"fit.models", {}, "", check};
  for (const RegistryEntry& model : list) {
    out.choices.push_back(model.name);
    out.meaning += (out.choices.size() == 1 ? "" : "; ") + model.name;
    for (const FitParameter& p : model.parameters) {
      out.meaning += (&p == &model.parameters.front() ? " (" : ", ") + p.name;
    }
    if (!model.parameters.empty()) out.meaning += ")";
  }
  out.meaning += std::string("; or ") + kOpenModels;
  return out;
}

bool fits_models(const Case& value) { return !value.get<FitSetup>().models.empty(); }

void fit_models(OwnWords models, std::vector<std::string> finite_elements, Study& study) {
  study.sections.push_back(kFitKeys);
  study.words = {std::move(models),
                 {"fit.finite_elements", std::move(finite_elements), "", nullptr}};
  study.figures.push_back(figures_of_fits);
  study.models_elsewhere = {"fit.models", fits_models};
}

}  // namespace

void declare_fit_keys(SectionKeys s) {
  s.word("models", IN(models), {},
         "models that are fitted and ranked, none where the list is empty",
         "Roul 4.3, 4.4, 5.6; Otto et al. 2003");
  s.or_none();
  s.word("finite_elements", IN(finite_elements), {},
         "finite-element models that are solved with the measured slope and the fitted constants "
         "and join the tables");
  s.or_none();
  s.word("components", IN(components), {"sigma_xx", "sigma_yy", "sigma_xy"},
         "stresses that are fitted, all together");
  s.flag("base", IN(base), "the forces on the base are fitted as well");
  s.number("heights", "-", IN(heights), {0, 1},
           "horizontal lines, shares of the pile's height above the base, 0 the base itself; all "
           "together");
  s.number("leave_out", "-", IN(leave_out), {1, 1e6},
           "numbers, from 1, of heaps that are left out (of another size, with a stray grain); "
           "warnings name them");
  s.or_none();
  s.number(
      "width_diameters", "-", IN(width_diameters), {0.01, 100},
      "coarse graining (Lucy kernel): its width in mean grain diameters; wider is smoother and "
      "keeps points further from the flanks");
  s.number("kernel", "-", IN(kernel), {0.01, 100},
           "kernel widths in mean grain diameters, e.g. 0.5, 1, 2, 4, at which the verdict is "
           "repeated; it says whether it changes");
  s.or_none();
  s.number("left_deg", "deg", IN(left_deg), {0, 89},
           "slope of the left flank; 0: measured on every heap");
  s.number("right_deg", "deg", IN(right_deg), {0, 89}, "the same on the right");
  s.number("friction_deg", "deg", IN(friction_deg), {0, 89},
           "friction angle of the models that take the flanks apart; 0: the steeper slope");
  s.number("huber", "-", IN(huber), {0, 1e6},
           "0: least squares; above: values further off than this many errors pull no more than "
           "that (points in the wrong region)");
  s.number("bootstrap", "-", IN(bootstrap), {0, 10000},
           "draws of the realizations for the bootstrap errors; below 10: none");
  s.number("coverage", "-", IN(coverage), {3, 1e6},
           "sizes N: how often intervals from N of the packings hold the constants of the rest "
           "(in the output folder: coverage.md); takes long");
  s.or_none();
  s.number("coverage_draws", "-", IN(coverage_draws), {1, 1e6},
           "draws of every size of fit.coverage");
  s.others_need_any("models");
}

void fit_heap_models(Study& study) {
  fit_models(models_of_list(heap_entries({}), check_heap_model),
             {"fe_osl_wedge", "fe_mohr_coulomb_wedge"}, study);
}

void fit_layer_models(Study& study) {
  fit_models(models_of_list(layer_entries(), check_layer_model),
             {"fe_elastic_half_space", "fe_elastic_layer", "fe_orthotropic_layer", "fe_osl_layer"},
             study);
}

void check_fit(const Case& value) {
  for (const std::string& name : value.get<FitSetup>().finite_elements) {
    try {
      continuum::find_model(name);
    } catch (const continuum::BadParameter& e) {
      throw std::invalid_argument(std::string("fit.finite_elements: ") + e.what());
    }
  }
}

}  // namespace grainfield::coupling

#undef IN
