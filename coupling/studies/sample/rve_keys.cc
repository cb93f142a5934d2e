// Keys of the RVEs of a sample: [rve].
#include "coupling/case/declare.h"
#include "coupling/studies/sample/rve_page.h"

namespace grainfield::coupling {

void declare_rve_keys(SectionKeys s) {
  s.number("along", "-", GRAINFIELD_MEMBER(RveSetup, along), {0, 10},
           "points along each axis, spread over the sample as widely as the spheres about them fit "
           "between walls; 2: eight RVEs, 0: none",
           "Wellmann 5");
  s.space();
  s.number("radii", "-", GRAINFIELD_MEMBER(RveSetup, radii), {0.5, 1000},
           "of the spheres, over sample.radius; such as do not fit into the sample are left out",
           "Wellmann 5");
  s.space();
}

std::vector<SummaryKey> rve_summary_keys() {
  return {
      {"rve.r*.grains", "-", "grains of an RVE whose radius is so many sample.radius"},
      {"rve.r*.error_bar", "-",
       "s/sqrt(N) of sigma_zz over the RVEs of a sample, over its mean; mean of the second half of "
       "the loading; the stress from the forces on the boundary over the hull"},
      {"rve.r*.grain_error_bar", "-",
       "the same of the stress from all contacts of the RVEs' grains over the sphere"},
      {"rve.r*.closure", "-",
       "largest |boundary - inside| over |inside| of the stress from the forces on the boundary "
       "and "
       "from the contacts inside, at rest"},
      {"rve.r*.stress_ratio", "-",
       "sigma_zz of the RVEs from the forces on their boundary over that of the sample, at the end "
       "of the loading"},
      {"rve.r*.grain_stress_ratio", "-", "the same from all contacts of the RVEs' grains"},
      {"rve.r*.field_ratio", "-", "the same of the coarse-grained field at their points"},
      {"rve.r*.axial_stress_ratio", "-",
       "q/p of the RVEs' mean stress from the forces on their boundary at the end of the loading, "
       "but for simple shear: q the stress along z less the mean along x and y (Wellmann 32)"},
      {"rve.r*.strain_ratio", "-",
       "strain of the hulls over that of the sample's edges at the end of the loading: zz, of a "
       "simple shear xz"},
      {"rve.r*.other_shear", "-",
       "largest of the hulls' mean shear strains that are not imposed over the imposed strain, at "
       "the end of the loading"},
      {"rve.r*.fit_ratio", "-", "strain by least squares over that of the hulls, likewise"},
      {"rve.contraction", "-",
       "simple shear: -trace/3 of the strain of the largest RVEs where its mean over the samples "
       "is "
       "least; the first state does not count, so it is below 0 where they dilate from the start"},
      {"rve.contraction_strain", "-",
       "shear strain xz of the samples there, its standard error by drawing samples anew"},
      {"rve.dilation", "-", "trace/3 of their strain at the end of the loading less the one there"},
  };
}

}  // namespace grainfield::coupling
