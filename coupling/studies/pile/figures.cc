#include "coupling/studies/pile/keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> pile_figures() {
  return {
      {"dem.repose_angle_left_deg", "deg", "slope of the pile's left flank (robust line)"},
      {"dem.repose_angle_right_deg", "deg", "slope of the right flank"},
      {"repose.mean_deg", "deg", "mean of both flanks"},
      {"repose.left_minus_right_deg", "deg", "how much steeper the left flank is"},
      {"pile.repose_error_left_deg", "deg", "standard error of one flank's line, from its scatter"},
      {"pile.repose_error_right_deg", "deg", "the same, right"},
      {"pile.height", "m", "h of a pile: its highest point above the floor"},
      {"pile.apex_x", "m", "where the flanks' lines meet, packing's axes"},
      {"pile.half_base_left", "m", "from the apex to the left flank's foot"},
      {"pile.half_base_right", "m", "from the apex to the right flank's foot"},
      {"pile.mean_diameter", "m", "of the grains' bounding circles"},
      {"pile.pour_time", "s", "simulated time of pouring"},
      {"pile.awake_mean", "-", "grains awake, mean over the pouring"},
      {"relaxation.base_weight_ratio_before", "-",
       "base force over weight before the last relaxation, in which all grains are awake; "
       "base.weight_ratio: after it"},
      {"relaxation.level_error_before", "-",
       "before it: largest |vertical force through a level / weight above - 1|, levels at tenths "
       "of "
       "the height with a twentieth of the weight above"},
      {"relaxation.level_error_after", "-", "the same after it"},
      {"relaxation.force_change", "-",
       "sum of what it changes of the contacts' forces, over the sum of these before"},
      {"relaxation.mean_displacement", "d", "mean way of a grain in it, mean diameters"},
      {"relaxation.largest_displacement", "d", "largest way, mean diameters"},
      {"pile.grains_not_poured", "-", "line source: left over when the pile came to a point"},
      {"source.kind", "text", "point | line"},
      {"source.interval", "s", "point source: from one grain to the next"},
      {"sleep.wake_reach", "-", "as in the case, when grains sleep while the pile is poured"},
      {"dem.grain_steps", "-", "grains times steps, all realizations"},
      {"pile.volume_fraction_centre", "-", "in a window about the apex (dem/heap)"},
      {"pile.volume_fraction_surface", "-", "in windows along the flanks"},
      {"heap.volume_fraction", "-",
       "mean of the inside: that of rho; piles too small for it: of all below the surface"},
      {"heap.rho_g_h", "N/m",
       "unit of pressure: grain density times heap.volume_fraction times g times height"},
      {"heap.coordination", "-", "contacts of a grain"},
      {"density.ratio", "-", "volume fraction about the apex over that along the flanks"},
      {"density.p_value", "-",
       "one-sided probability of a ratio this high if it were 1 (Student's t over realizations)"},
      {"base.centre_pressure", "rho g h", "ensemble mean under the apex, smeared"},
      {"base.largest_pressure", "rho g h", "largest of the ensemble mean"},
      {"base.largest_at", "h", "its distance from the apex"},
      {"base.smearing_width", "m", "width of the kernel that smears base forces"},
      {"dip.ratio", "-", "centre pressure over largest pressure at the base, ensemble mean"},
      {"dip.centre", "rho g h",
       "mean base pressure for |x| below heap.centre half bases, mean over realizations"},
      {"dip.shoulder", "rho g h",
       "mean base pressure from heap.shoulder_from to heap.shoulder_to, both sides"},
      {"axis.stress_ratio", "-",
       "sigma_xx over sigma_yy on the axis, both averaged over |x| below heap.centre half bases "
       "and "
       "heights from heap.axis_from to heap.axis_to; mean over realizations"},
      {"dip.window_ratio", "-", "dip.centre over dip.shoulder"},
      {"dip.difference", "rho g h", "shoulder - centre, mean over realizations: above 0 is a dip"},
      {"dip.standard_error", "rho g h", "its standard error over realizations"},
      {"dip.p_value", "-",
       "one-sided probability of a difference this high if it were 0 (Student's t); nan below 3 "
       "realizations; the verdict's p is two-sided: 2 min(p, 1 - p)"},
      {"dip.verdict", "text",
       "dip | peak | neither | undecided (at 5 %, two-sided: 2 min(p, 1 - p))"},
      {"change.*.coordination", "-", "contacts of a grain under the changed gravity"},
      {"change.*.coordination_ratio", "-", "the same over that of the pile"},
      {"change.*.dip_difference_change", "rho g h",
       "change of shoulder - centre, in units of the changed rho g h"},
      {"change.*.contacts_gained", "-", "contacts that the change of gravity closed"},
      {"change.*.contacts_lost", "-", "contacts that it opened"},
      {"change.*.unbalanced_force_ratio", "-", "mean resultant over mean contact force there"},
      {"change.*.load_steps", "-", "load steps of Newton's method on the way there"},
      {"change.*.iterations", "-", "its iterations in all of them"},
      {"change.*.newly_sliding", "-", "contacts that it brought to the Coulomb limit"},
      {"change.*.max_displacement_over_radius", "-",
       "largest displacement from the pile, over the grain's radius"},
  };
}

}  // namespace grainfield::coupling
