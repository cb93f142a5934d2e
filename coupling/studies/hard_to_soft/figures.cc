#include "coupling/studies/hard_to_soft/keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> switch_figures() {
  return {
      {"switch.at_rest", "-", "1: the grains are at rest; 0: they still move after max_time",
       "at rest"},
      {"switch.time", "-", "simulated, in sqrt(d/g)"},
      {"switch.soft_share", "-", "share of the grains that are soft at the end", "soft"},
      {"switch.collisions", "-", "impulses", "impulses"},
      {"switch.to_soft", "-", "times that a hard grain became soft"},
      {"switch.to_hard", "-", "times that a soft grain became hard"},
      {"switch.pressed", "-",
       "pairs that became soft in overlap, or because impulses found no end within a step"},
      {"switch.lost_impulses", "m g d", "energy that impulses took", "lost by them / (m g d)"},
      {"switch.lost_soft", "m g d", "energy that soft contacts took", "by soft contacts"},
      {"switch.switched", "m g d", "elastic energy of overlaps that began with a switch"},
      {"switch.balance_error", "m g d",
       "largest change of the total energy with all losses, less what was switched",
       "balance / (m g d)"},
      {"switch.iterations", "-", "of Newton's method, mean of all solves"},
      {"switch.halved", "-", "steps or parts of steps that were halved"},
  };
}

}  // namespace grainfield::coupling
