#include "coupling/studies/wedge/keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> wedge_figures() {
  return {
      {"wedge.*.base_shape", "text", "pressure on the heap's base: dip, plateau, peak"},
      {"wedge.*.base_axis", "-",
       "mean pressure on the base within 5 % of its half width from the axis, over rho g h; where "
       "the pressure has a kink there, not its value at x = 0 (Cantelaube's minus branch at 28 "
       "deg: 0.31, at x = 0 0.22)"},
      {"wedge.*.base_largest", "-", "largest pressure on the base over rho g h"},
      {"wedge.*.base_largest_at", "-", "its distance from the axis over h"},
      {"wedge.*.dip_ratio", "-", "base_axis over base_largest"},
      {"wedge.*.nearest", "text", "label of the closed wedge nearest to the heap's base pressure"},
      {"wedge.*.nearest_rel_l2", "-", "its relative L2 distance from it"},
      {"wedge.*.failed", "text", "why there is no such heap"},
      {"wedge.heaps", "-", "heaps that were tried"},
      {"wedge.equilibria", "-", "of these, heaps with an equilibrium"},
      {"wedge.dips", "-", "of these, with a dip"},
      {"wedge.plateaus", "-", "with a plateau"},
      {"wedge.peaks", "-", "with a peak"},
  };
}

}  // namespace grainfield::coupling
