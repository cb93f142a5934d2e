#include "coupling/studies/implicit_settling/keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> settling_figures() {
  return {
      {"settling.at_rest", "-", "1: the pile is at rest; 0: it still moves after max_time",
       "at rest"},
      {"settling.time", "-", "simulated, in sqrt(d/g)"},
      {"settling.normal_max_error", "-",
       "largest difference of a base disk's N from the closed form (Liffman 42) over the largest "
       "N",
       "N: largest error"},
      {"settling.horizontal_max_error", "-", "the same of H (Liffman 44)", "H: largest error"},
      {"settling.row_contacts", "-", "contacts between neighbours of a row at the end"},
      {"settling.iterations", "-", "of Newton's method, mean of all solves", "iterations a solve"},
      {"settling.most_iterations", "-", "of one solve"},
      {"settling.halved", "-", "steps or parts of steps that were halved", "halved"},
      {"settling.balance_error", "m g d",
       "largest change of kinetic, potential and elastic energy with all losses",
       "balance / (m g d)"},
      {"settling.lost_normal", "m g d", "energy that dashpots along the normal took"},
      {"settling.lost_tangential", "m g d", "energy that friction took"},
      {"settling.lost_well", "m g d", "energy that the wells took"},
      {"settling.lost_scheme", "m g d", "energy that settling.scheme = \"bdf2\" took by itself"},
      {"settling.spread", "d", "by how much the outermost base disks have parted", "spread / d"},
      {"settling.spread_speed", "sqrt(g d)",
       "how fast they part in the last tenth of the records; 0 at rest", "its speed / sqrt(g d)"},
  };
}

}  // namespace grainfield::coupling
