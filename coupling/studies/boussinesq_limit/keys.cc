// Keys of [response].
#include "coupling/case/declare.h"
#include "coupling/studies/boussinesq_limit/setup.h"

namespace grainfield::coupling {

void declare_response_keys(SectionKeys s) {
  s.number("loads", "-", GRAINFIELD_MEMBER(ResponseSetup, loads), {1, 10000},
           "places of the load on each layer, one after the other with the same factors; in space "
           "a square number");
  s.number("grains", "-", GRAINFIELD_MEMBER(ResponseSetup, grains), {1, 1000},
           "grains of the surface that share the load in equal parts: those nearest to the place");
  s.number("span", "-", GRAINFIELD_MEMBER(ResponseSetup, span), {0, 0.9},
           "in the plane: share of the width, in its middle, that the places are spread over; "
           "profiles end where the outermost place is from its wall");
  s.number("width_depths", "-", GRAINFIELD_MEMBER(ResponseSetup, width_depths), {1e-3, 1},
           "second width of averaging over the layer's depth, beside average.width_diameters");
  s.number("strain", "-", GRAINFIELD_MEMBER(ResponseSetup, strain), {1e-9, 1e-4},
           "size of the small strains that the moduli follow from");
  s.number("slabs", "-", GRAINFIELD_MEMBER(ResponseSetup, slabs), {1, 100},
           "slabs of equal thickness that have moduli of their own");
  s.number("strips", "-", GRAINFIELD_MEMBER(ResponseSetup, strips), {1, 100},
           "parts of a slab whose scatter is its error in a single layer");
  s.flag(
      "finite_elements", GRAINFIELD_MEMBER(ResponseSetup, finite_elements),
      "predict with the moduli by depth, too, stress and settlement, by finite elements (minutes "
      "in space)");
}

}  // namespace grainfield::coupling
