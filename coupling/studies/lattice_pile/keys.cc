// Keys of lattice piles: [lattice].
#include "coupling/studies/lattice_pile/keys.h"

#include "coupling/case/declare.h"
#include "coupling/studies/lattice_pile/simulation.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(dem::LatticePileSetup, lattice.MEMBER)

namespace grainfield::coupling {

void declare_lattice_keys(SectionKeys s) {
  s.number("base_grains", "-", IN(base_grains), {3, 2000},
           "disks in the lowest row, and rows of the equilateral pile; the pile is as many times "
           "softer against its own weight",
           "Liffman et al. 1992, fig. 7");
  s.number("slope_deg", "deg", IN(slope_deg), {1, 60},
           "of the outline: rows end under it; 60 is the equilateral pile",
           "Liffman et al. 1992, fig. 13");
  s.number("top_slope_deg", "deg", IN(top_slope_deg), Range{1, 60}.with_zero(),
           "of the outline above its bend, a \"tent\"; 0: no bend",
           "Liffman et al. 1992, fig. 18, 19: 45 above 30");
  s.number("bend", "-", IN(bend), {0, 0.499},
           "distance of the bend from the corner along the base, over the base; farther: a shorter "
           "top",
           "Liffman et al. 1992, fig. 19: 0.38");
  s.number("radius", "m", IN(radius), kRadius,
           "of the disks; larger: heavier, and a longer time step");
  s.number("gap", "-", IN(gap), {0, 0.5},
           "between neighbours of a row, in diameters; raises H by 4/3 of it; 0: neighbours touch, "
           "and below 60 degrees carry force along the rows");
}

}  // namespace grainfield::coupling

#undef IN
