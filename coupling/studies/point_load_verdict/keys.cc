// Keys of fits of stress models to layers under a point load.
#include "coupling/studies/point_load_verdict/keys.h"

#include "coupling/case/declare.h"
#include "coupling/fit/layer_models.h"
#include "coupling/fit/open_models.h"
#include "coupling/observe/setup.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(VerdictSetup, MEMBER)

namespace grainfield::coupling {
namespace {

using std::string;

}  // namespace

void declare_verdict_keys(SectionKeys s) {
  std::vector<string> names;
  for (const RegistryEntry& model : layer_entries()) names.push_back(model.name);
  s.word("models", IN(models), names,
         "models that are fitted to the response and ranked; free: layer_rough nu; "
         "orthotropic_half_plane, orthotropic_layer_smooth rho, t; orthotropic_layer_rough shear, "
         "t, nu_ratio; osl_layer_* eta, mu, width; or " +
             string(kOpenModels),
         "Otto et al. 2003; Roul 5.6");
  s.or_else(refused_layer_model);
  s.word("finite_elements", IN(finite_elements),
         {"fe_elastic_half_space", "fe_elastic_layer", "fe_orthotropic_layer", "fe_osl_layer"},
         "finite-element models that are solved with the fitted constants and join the tables");
  s.or_none();
  s.word("components", IN(components), {"sigma_xx", "sigma_yy", "sigma_xy"},
         "stresses that are fitted, all together");
  s.flag("base", IN(base), "the forces on the base are fitted as well");
  s.number("kernel", "-", IN(kernel), {0.01, 100},
           "kernel widths in mean grain diameters, e.g. 0.5, 1, 2, 4, at which the verdict is "
           "repeated; it says whether it changes");
  s.or_none();
  s.number("coverage", "-", IN(coverage), {3, 1e6},
           "sizes N: how often intervals from N of the packings hold the constants of the rest "
           "(in the output folder: coverage.md); takes long");
  s.or_none();
  s.number("coverage_draws", "-", IN(coverage_draws), {1, 1e6},
           "draws of every size of verdict.coverage");
  s.number("bootstrap", "-", IN(bootstrap), {0, 10000},
           "draws of the packings for the bootstrap errors; below 10: none");
}

}  // namespace grainfield::coupling

#undef IN
