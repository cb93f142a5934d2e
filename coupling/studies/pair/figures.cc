#include "coupling/studies/pair/keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> pair_figures() {
  return {
      {"pair.restitution_normal", "-",
       "velocity at the contact along the first normal, after over before, with the sign turned",
       "e_n"},
      {"pair.restitution_tangential", "-", "the same across the normal, along the slip before",
       "e_t"},
      {"pair.duration", "s", "from the first touch until the normal force is 0", "duration (s)"},
      {"pair.max_depth", "m", "largest overlap along the normal; random loops: of the first",
       "largest depth (m)"},
      {"pair.max_force", "N", "largest normal force"},
      {"pair.energy_lost", "-", "share of the kinetic energy before that is not there after"},
      {"pair.parted", "-", "1: the bodies came apart; 0: not within 2000 half periods"},
      {"pair.closed_form.restitution_normal", "-",
       "closed form of a force that never pulls (linear; hertz, critical; energy, square)",
       "closed form"},
      {"pair.closed_form.restitution_tangential", "-",
       "linear law without dashpots: slip throughout where the spring of friction is always at its "
       "limit, else as without slip, which is the limit of small angles (Walton 1993)",
       "closed form of e_t"},
      {"pair.closed_form.duration", "s", "where the law has one: linear, and without dashpot",
       "closed form (s)"},
      {"pair.closed_form.max_depth", "m", "where the law has one", "closed form (m)"},
      {"pair.closed_form.max_force", "N", "where the law has one, without dashpot"},
      {"pair.work", "J", "work on the first body along the path; random: along the first loop",
       "work (J)"},
      {"pair.stored_most", "J", "largest energy stored on the path; random: on the first loop",
       "stored at most (J)"},
      {"pair.loops", "-", "closed paths that were passed"},
      {"pair.loop_work_over_energy", "-",
       "|work| round a closed path over the largest energy stored on it; random: the largest",
       "largest |loop work| / energy"},
      {"pair.loop_work_over_energy_mean", "-", "its mean over the loops", "mean"},
      {"pair.loops_crossing", "-", "loops on which the outlines cross at more than two places",
       "crossing more than twice"},
      {"pair.loops_unsettled", "-",
       "loops whose work finer steps still changed by more than 2e-6 of that energy",
       "not settled"},
      {"pair.stable_time_step", "s", "limit of the time step of these two bodies"},
      {"pair.*.restitution_normal", "-", "of a further impact: pair.speed_V or pair.angle_A"},
      {"pair.*.restitution_tangential", "-", "likewise"},
      {"pair.*.duration", "s", "likewise"},
      {"pair.*.max_depth", "m", "likewise"},
      {"pair.*.max_force", "N", "likewise"},
      {"pair.*.energy_lost", "-", "likewise"},
      {"pair.*.parted", "-", "likewise"},
      {"pair.*.closed_form.restitution_normal", "-", "closed form of a further impact"},
      {"pair.*.closed_form.restitution_tangential", "-", "likewise"},
      {"pair.*.closed_form.duration", "s", "likewise"},
      {"pair.*.closed_form.max_depth", "m", "likewise"},
      {"pair.*.closed_form.max_force", "N", "likewise"},
  };
}

}  // namespace grainfield::coupling
