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

}  // namespace grainfield::coupling
