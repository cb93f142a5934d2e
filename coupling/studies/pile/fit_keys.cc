// Keys of fits of stress models to piles: [fit].
#include "coupling/case/declare.h"
#include "coupling/fit/models.h"
#include "coupling/fit/open_models.h"
#include "coupling/observe/setup.h"
#include "coupling/studies/pile/keys.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(FitSetup, MEMBER)

namespace grainfield::coupling {
namespace {

using std::string;

}  // namespace

void declare_fit_keys(SectionKeys s) {
  std::vector<string> names;
  string meaning = "models that are fitted and ranked, none where the list is empty";
  for (const RegistryEntry& model : heap_entries({})) {
    names.push_back(model.name);
    meaning += (names.size() == 1 ? ": " : "; ") + model.name;
    if (!model.parameters.empty()) {
      meaning += " (";
      for (const FitParameter& p : model.parameters) {
        meaning += (&p == &model.parameters.front() ? "" : ", ") + p.name;
      }
      meaning += ")";
    }
  }
  s.word("models", IN(models), names, meaning + "; or " + kOpenModels, "Roul 4.3, 4.4");
  s.or_else(refused_heap_model);
  s.or_none();
  s.word(
      "finite_elements", IN(finite_elements), {"fe_osl_wedge", "fe_mohr_coulomb_wedge"},
      "finite-element models that are solved with the measured slope and the fitted constants and "
      "join the tables");
  s.or_none();
  s.word("components", IN(components), {"sigma_xx", "sigma_yy", "sigma_xy"},
         "stresses that are fitted, all together");
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
           "draws of the piles for the bootstrap errors; below 10: none");
  s.others_need_any("models");
}

}  // namespace grainfield::coupling

#undef IN
