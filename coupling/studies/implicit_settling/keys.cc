// Keys of piles that settle under implicit motion: [settling].
#include "coupling/studies/implicit_settling/keys.h"

#include "coupling/case/declare.h"
#include "coupling/studies/implicit_settling/simulation.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(dem::ImplicitSettlingSetup, MEMBER)

namespace grainfield::coupling {

void declare_settling_keys(SectionKeys s) {
  constexpr Range kDashpot{0, 1e3};
  s.number("density", "kg/m2", IN(density), {1e-3, 1e6}, "of the disks, areal");
  s.number("gravity", "m/s2", IN(gravity), kAcceleration, "downwards");
  s.number("softness", "-", IN(softness), {1e-9, 1e-2},
           "m g/(K d), how far a disk sinks into the ground by its own weight, in diameters; it "
           "sets K",
           "Liffman et al. 1992, eq. 46");
  s.number("damping", "-", IN(damping), kDashpot,
           "K_D/sqrt(m K) along the normal; a pair is critically damped at sqrt 2",
           "Liffman et al. 1992, eq. 25");
  s.word("friction", IN(friction), {"none", "viscous", "coulomb"},
         "viscous: the source's sliding and rolling friction, which vanishes at rest; coulomb: a "
         "spring with memory and a limit, beyond the source",
         "Liffman et al. 1992, eqs 27-32");
  s.number("slip_damping", "-", IN(slip_damping), kDashpot,
           "K_slip/sqrt(m K) of sliding; more: slower creep, and stiffer steps",
           "Liffman et al. 1992, eq. 27");
  s.only("settling.friction", {"viscous", "coulomb"});
  s.number("rolling_friction", "-", IN(rolling_friction), {0, 10},
           "mu_roll: viscous friction is at most this share of the normal force; 0: none",
           "Liffman et al. 1992, eq. 29");
  s.only("settling.friction", {"viscous"});
  s.number("coulomb", "-", IN(coulomb), {0, 10}, "coefficient mu");
  s.only("settling.friction", {"coulomb"});
  s.number("tangential_ratio", "-", IN(tangential_ratio), {1e-3, 1e3}, "k_t/K of the spring");
  s.only("settling.friction", {"coulomb"});
  s.number(
      "static_friction", "-", IN(static_friction), {0, 10},
      "mu_static of the ground's wells: what a disk holds at their edge; a sudden push of more "
      "than half of it may free the disk; 0: no wells",
      "Liffman et al. 1992, eq. 30");
  s.number("well", "-", IN(well), Range{1e-9, 1}.with_zero(),
           "half width a of the wells, in diameters; smaller: stiffer",
           "Liffman et al. 1992, eq. 30");
  s.flag("base_spins", IN(base_spins),
         "whether the lowest row may roll; the source's wells act on centres and do not turn it");
  s.word("scheme", IN(scheme), {"conserving", "bdf2"},
         "conserving: the source's, which keeps energy at any step; bdf2: the two-step backward "
         "difference formula, whose own loss lets die out what swings too fast for the step",
         "conserving: Liffman et al. 1992, eqs 23-36");
  s.number("step", "-", IN(step), {1e-3, 1e4},
           "time step over (1/10) pi sqrt(m/K), what explicit integrators take; the ways are "
           "followed to second order in it");
  s.number("relaxation", "-", IN(relaxation), {0.05, 1},
           "share of Newton's step that is tried first; below 1 more iterations",
           "Liffman et al. 1992: 0.5 to 0.9");
  s.number("tolerance", "-", IN(tolerance), {1e-14, 1e-2},
           "of Newton's residual over the largest force; no less than round-off");
  s.number("max_iterations", "-", IN(max_iterations), {1, 10000},
           "of Newton's method, beyond which a step is halved");
  s.number("rest", "-", IN(rest), kRatioOfForces,
           "mean resultant over mean contact force at which the pile is at rest");
  s.number("max_time", "-", IN(max_time), {1e-3, 1e6},
           "in sqrt(d/g): piles that creep do not come to rest, and end then");
  s.number("records", "-", IN(records), {2, 100000}, "points of the curves over max_time");
}

}  // namespace grainfield::coupling

#undef IN
