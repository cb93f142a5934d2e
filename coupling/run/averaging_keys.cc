// Keys of averaging: [average].
#include "coupling/case/declare.h"
#include "coupling/run/averaging_setup.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(AverageSetup, MEMBER)

namespace grainfield::coupling {
namespace {

using std::string;

}  // namespace

void declare_average_keys(SectionKeys s) {
  s.word("methods", IN(methods), {"coarse_graining", "particle_centre", "area_exact"},
         "averagings to report; the first one is compared with the models",
         "Weinhart et al. 2012; Roul 2.6");
  s.word("kernel", IN(kernel), {"lucy", "gaussian", "heaviside"}, "the weight",
         "Weinhart et al. 2012");
  s.only("average.methods", {"coarse_graining"});
  s.number("width", "m", IN(width), kLength.with_zero(),
           "w of the kernel (lucy ends at 2 w); wider is smoother and blurs "
           "peaks; 0: width_diameters mean diameters");
  s.only("average.methods", {"coarse_graining"});
  s.number("width_diameters", "-", IN(width_diameters), {0.01, 100},
           "the same in mean grain diameters, used where width is 0");
  s.only("average.width", {"0.0"});
  s.word("rve_shape", IN(rve_shape), {"circle", "square"},
         "shape of the representative volume element");
  s.only("average.methods", {"particle_centre", "area_exact"});
  s.number("rve_radius", "m", IN(rve_radius), kLength.with_zero(),
           "radius or half side; larger is smoother; 0: rve_diameters mean "
           "diameters",
           "Roul 3.2");
  s.only("average.methods", {"particle_centre", "area_exact"});
  s.number("rve_diameters", "-", IN(rve_diameters), {0.01, 100},
           "the same in mean grain diameters, used where rve_radius is 0");
  s.only("average.rve_radius", {"0.0"});
  s.number("depths", "-", IN(depths), {1e-6, 1},
           "profiles below the surface, as shares of the layer's height; the base is always added");
  s.number("points", "-", IN(points), {3, 10000}, "of a profile");
  s.number("half_width", "m", IN(half_width), kLength.with_zero(),
           "profiles reach this far to either side of the load; 0: to the nearer side wall");
  s.number("map_columns", "-", IN(map_columns), {2, 2000}, "points of the maps along x");
  s.number("map_rows", "-", IN(map_rows), {2, 2000}, "points of the maps along y");
}

}  // namespace grainfield::coupling

#undef IN
