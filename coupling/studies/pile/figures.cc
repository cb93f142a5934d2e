#include "coupling/studies/pile/figures.h"

#include "coupling/run/finished_runs.h"
#include "coupling/specimen/axis_stress.h"
#include "coupling/statistics/spread.h"
#include "coupling/studies/pile/keys.h"
#include "coupling/studies/pile/pile_ensemble.h"
#include "coupling/studies/pile/simulation.h"

namespace grainfield::coupling {
namespace {

using Value = std::optional<FigureValue>;

// Grains times steps, summed over the piles; none where they come from files.
Value grain_steps(const FigureSamples& figures) {
  const auto grains = figures.find("dem.grains"), steps = figures.find("dem.steps");
  if (grains == figures.end() || steps == figures.end()) return std::nullopt;
  double sum = 0;
  for (std::size_t r = 0; r < grains->second.size(); ++r) {
    sum += grains->second[r] * steps->second[r];
  }
  return sum;
}

}  // namespace

const std::vector<Figure<PileFacts>>& pile_rows() {
  using F = const PileFacts&;
  static const std::vector<Figure<PileFacts>> all{
      {"dem.repose_angle_left_deg", "deg", "slope of the pile's left flank (robust line)",
       [](F f) { return f.frame.repose_left_deg; }},
      {"dem.repose_angle_right_deg", "deg", "slope of the right flank",
       [](F f) { return f.frame.repose_right_deg; }},
      {"repose.mean_deg", "deg", "mean of both flanks",
       [](F f) { return (f.left_deg + f.right_deg) / 2; }, "repose (deg)"},
      {"repose.left_minus_right_deg", "deg", "how much steeper the left flank is",
       [](F f) { return f.left_deg - f.right_deg; }, "left - right (deg)"},
      {"pile.repose_error_left_deg", "deg", "standard error of one flank's line, from its scatter"},
      {"pile.repose_error_right_deg", "deg", "the same, right"},
      {"pile.height", "m", "h of a pile: its highest point above the floor",
       [](F f) { return f.frame.height; }},
      {"pile.apex_x", "m", "where the flanks' lines meet, packing's axes"},
      {"pile.half_base_left", "m", "from the apex to the left flank's foot",
       [](F f) { return f.frame.half_left; }},
      {"pile.half_base_right", "m", "from the apex to the right flank's foot",
       [](F f) { return f.frame.half_right; }},
      {"pile.mean_diameter", "m", "of the grains' bounding circles",
       [](F f) { return f.frame.diameter; }},
      {"pile.pour_time", "s", "simulated time of pouring"},
      {"pile.awake_mean", "-", "grains awake, mean over the pouring"},
      {"relaxation.base_weight_ratio_before", "-",
       "base force over weight before the last relaxation, in which all grains are awake; "
       "base.weight_ratio: after it"},
      {"relaxation.level_error_before", "-",
       "before it: largest |vertical force through a level / weight above - 1|, levels at tenths "
       "of the height with a twentieth of the weight above"},
      {"relaxation.level_error_after", "-", "the same after it"},
      {"relaxation.force_change", "-",
       "sum of what it changes of the contacts' forces, over the sum of these before"},
      {"relaxation.mean_displacement", "d", "mean way of a grain in it, mean diameters"},
      {"relaxation.largest_displacement", "d", "largest way, mean diameters"},
      {"pile.grains_not_poured", "-", "line source: left over when the pile came to a point"},
      {"pile.volume_fraction_centre", "-", "in a window about the apex (coupling/specimen)",
       [](F f) { return f.frame.centre_fraction; }},
      {"pile.volume_fraction_surface", "-", "in windows along the flanks",
       [](F f) { return f.frame.surface_fraction; }},
      {"heap.volume_fraction", "-",
       "mean of the inside: that of rho; piles too small for it: of all below the surface",
       [](F f) { return f.frame.volume_fraction; }, "volume fraction"},
      {"heap.rho_g_h", "N/m",
       "unit of pressure: grain density times heap.volume_fraction times g times height",
       [](F f) { return f.frame.pressure(); }},
      {"heap.coordination", "-", "contacts of a grain", [](F f) { return coordination(f.pile); },
       "contacts per grain"},
      {"density.ratio", "-", "volume fraction about the apex over that along the flanks",
       [](F f) { return f.frame.centre_fraction / f.frame.surface_fraction; }},
      {"axis.stress_ratio", "-",
       "sigma_xx over sigma_yy on the axis, both averaged over |x| below heap.centre half bases "
       "and heights from heap.axis_from to heap.axis_to; mean over realizations",
       [](F f) { return axis_stress_ratio(f.pile, f.frame, f.heap); },
       "sigma_xx / sigma_yy on the axis"},
  };
  return all;
}

const std::vector<Figure<BaseWindows>>& window_rows() {
  using W = const BaseWindows&;
  static const std::vector<Figure<BaseWindows>> all{
      {"dip.centre", "rho g h",
       "mean base pressure for |x| below heap.centre half bases, mean over realizations",
       [](W w) { return w.centre; }, "centre pressure (rho g h)"},
      {"dip.shoulder", "rho g h",
       "mean base pressure from heap.shoulder_from to heap.shoulder_to, both sides",
       [](W w) { return w.shoulder; }},
  };
  return all;
}

const std::vector<Figure<ChangeFacts>>& change_rows() {
  using F = const ChangeFacts&;
  static const std::vector<Figure<ChangeFacts>> all{
      {"coordination", "-", "contacts of a grain under the changed gravity",
       [](F f) { return f.coordination; }},
      {"coordination_ratio", "-", "the same over that of the pile",
       [](F f) { return f.coordination / f.coordination_before; }},
      {"dip_difference_change", "rho g h",
       "change of shoulder - centre, in units of the changed rho g h",
       [](F f) { return f.difference - f.difference_before; }},
      {"contacts_gained", "-", "contacts that the change of gravity closed"},
      {"contacts_lost", "-", "contacts that it opened"},
      {"unbalanced_force_ratio", "-", "mean resultant over mean contact force there"},
      {"load_steps", "-", "load steps of Newton's method on the way there"},
      {"iterations", "-", "its iterations in all of them"},
      {"newly_sliding", "-", "contacts that it brought to the Coulomb limit"},
      {"max_displacement_over_radius", "-",
       "largest displacement from the pile, over the grain's radius"},
  };
  return all;
}

const std::vector<RunFigure<Case>>& source_rows() {
  static const std::vector<RunFigure<Case>> all{
      {"source.kind", "text", "point | line",
       [](const Case& value) { return value.get<dem::PileSetup>().source.kind; }},
      {"source.interval", "s", "point source: from one grain to the next",
       [](const Case& value) -> Value {
         const auto& source = value.get<dem::PileSetup>().source;
         return source.kind == "point" ? Value(source.interval) : std::nullopt;
       }},
  };
  return all;
}

const std::vector<RunFigure<PilesFacts>>& piles_rows() {
  using F = const PilesFacts&;
  static const std::vector<RunFigure<PilesFacts>> all{
      {"sleep.wake_reach", "-", "as in the case, when grains sleep while the pile is poured",
       [](F f) -> Value {
         const auto& sleep = f.value.get<dem::PileSetup>().sleep;
         const bool poured = f.value.get<GrainFiles>().files.empty();
         return sleep.on && poured ? Value(sleep.wake_reach) : std::nullopt;
       }},
      {"dem.grain_steps", "-", "grains times steps, all realizations",
       [](F f) { return grain_steps(f.figures); }},
      {"density.p_value", "-",
       "one-sided probability of a ratio this high if it were 1 (Student's t over realizations)",
       [](F f) {
         std::vector<double> over = f.figures.at("density.ratio");
         for (double& ratio : over) ratio -= 1;
         return spread_of(over).p_value;
       }},
  };
  return all;
}

const std::vector<RunFigure<BaseFacts>>& base_rows() {
  using F = const BaseFacts&;
  static const std::vector<RunFigure<BaseFacts>> all{
      {"base.centre_pressure", "rho g h", "ensemble mean under the apex, smeared",
       [](F f) { return f.centre; }},
      {"base.largest_pressure", "rho g h", "largest of the ensemble mean",
       [](F f) { return f.largest; }},
      {"base.largest_at", "h", "its distance from the apex", [](F f) { return f.largest_at; }},
      {"base.smearing_width", "m", "width of the kernel that smears base forces",
       [](F f) { return f.width; }},
      {"dip.ratio", "-", "centre pressure over largest pressure at the base, ensemble mean",
       [](F f) { return f.centre / f.largest; }, "dip ratio"},
  };
  return all;
}

const std::vector<RunFigure<Dip>>& dip_rows() {
  using D = const Dip&;
  static const std::vector<RunFigure<Dip>> all{
      {"dip.window_ratio", "-", "dip.centre over dip.shoulder", [](D d) { return d.window_ratio; }},
      {"dip.difference", "rho g h", "shoulder - centre, mean over realizations: above 0 is a dip",
       [](D d) { return d.difference.mean; }, "dip difference (rho g h)", "dip.standard_error"},
      {"dip.standard_error", "rho g h", "its standard error over realizations",
       [](D d) { return d.difference.standard_error; }},
      {"dip.p_value", "-",
       "one-sided probability of a difference this high if it were 0 (Student's t); nan below 3 "
       "realizations; the verdict's p is two-sided: 2 min(p, 1 - p)",
       [](D d) { return d.difference.p_value; }, "p of a dip, one-sided"},
      {"dip.verdict", "text",
       "dip | peak | neither | undecided (at 5 %, two-sided: 2 min(p, 1 - p))",
       [](D d) { return d.verdict; }},
  };
  return all;
}

std::vector<SummaryKey> pile_figures() {
  return joined({declared(pile_rows()), declared(source_rows()), declared(piles_rows()),
                 declared(base_rows()), declared(window_rows()), declared(dip_rows()),
                 declared(change_rows(), "change.*.")});
}

}  // namespace grainfield::coupling
