// Keys of hard disks that turn soft: [switch].
#include "coupling/studies/hard_to_soft/keys.h"

#include "coupling/case/declare.h"
#include "coupling/studies/hard_to_soft/simulation.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(dem::HardToSoftSetup, MEMBER)

namespace grainfield::coupling {

void declare_switch_keys(SectionKeys s) {
  s.word("source", IN(source), {"rain", "drop"},
         "rain: all at once into a box; drop: one at a time onto a pile");
  s.number("columns", "-", IN(columns), {1, 1000}, "disks side by side at the start; a wider box");
  s.only("switch.source", {"rain"});
  s.number("rows", "-", IN(rows), {1, 10000}, "disks one above the other at the start");
  s.only("switch.source", {"rain"});
  s.number("grains", "-", IN(grains), {1, 10000}, "disks that are dropped",
           "Liffman et al. 1992, fig. 20");
  s.only("switch.source", {"drop"});
  s.number("above", "-", IN(above), {0.1, 100},
           "from how far above the pile's highest point each disk falls, in diameters",
           "Liffman et al. 1992, fig. 20");
  s.only("switch.source", {"drop"});
  s.number("interval", "-", IN(interval), {0.1, 1e4},
           "from one disk to the next, in sqrt(d/g); less: the next one meets a moving pile");
  s.only("switch.source", {"drop"});
  s.number("spread", "-", IN(spread), {0, 100},
           "disks start within this from the axis, in radii; wider: a flatter top");
  s.only("switch.source", {"drop"});
  s.number("floor", "-", IN(floor), {5, 1e4},
           "length of the ground, in diameters, between walls that catch strays");
  s.only("switch.source", {"drop"});
  s.number("radius", "m", IN(radius), kRadius, "mean radius");
  s.number("polydispersity", "-", IN(polydispersity), {0, 0.5},
           "radii uniform in (1 -+ this) times the radius; 0: the heap may crystallize");
  s.number("clearance", "-", IN(clearance), {0.01, 100},
           "between the rows and below the lowest, in diameters; more: a longer fall");
  s.only("switch.source", {"rain"});
  s.number("density", "kg/m2", IN(density), {1e-3, 1e6}, "of the disks, areal");
  s.number("gravity", "m/s2", IN(gravity), kAcceleration, "downwards");
  s.number("restitution", "-", IN(restitution), {0, 1},
           "speed of parting over that of approach, of impulses between hard grains; less: soft "
           "sooner",
           "Liffman et al. 1992, eq. 4");
  s.number("impact_friction", "-", IN(impact_friction), {0, 10}, "of these impulses",
           "Liffman et al. 1992, eq. 7");
  s.number("softness", "-", IN(softness), {1e-9, 1e-2},
           "m g/(K d), how far a disk sinks into the ground by its own weight, in diameters; it "
           "sets K",
           "Liffman et al. 1992, eq. 46");
  s.number("damping", "-", IN(damping), {0, 1e3}, "K_D/sqrt(m K) of soft contacts",
           "Liffman et al. 1992, eq. 25");
  s.word("friction", IN(friction), {"coulomb", "viscous"},
         "of soft contacts; viscous: the source's sliding and rolling friction, which vanishes at "
         "rest; coulomb: a spring with memory and a limit, beyond the source",
         "Liffman et al. 1992, eqs 27-32");
  s.number("coulomb", "-", IN(coulomb), {0, 10}, "friction coefficient of soft contacts");
  s.only("switch.friction", {"coulomb"});
  s.number("tangential_ratio", "-", IN(tangential_ratio), {1e-3, 1e3}, "k_t/K of its spring");
  s.only("switch.friction", {"coulomb"});
  s.number("slip_damping", "-", IN(slip_damping), {0, 1e3},
           "K_slip/sqrt(m K) of sliding; more: slower creep, and stiffer steps",
           "Liffman et al. 1992, eq. 27");
  s.only("switch.friction", {"viscous"});
  s.number("rolling_friction", "-", IN(rolling_friction), {0, 10},
           "mu_roll: viscous friction is at most this share of the normal force; 0: none",
           "Liffman et al. 1992, eq. 29");
  s.only("switch.friction", {"viscous"});
  s.number("static_friction", "-", IN(static_friction), {0, 10},
           "mu_static of the ground's wells, which form where a disk touches the ground and anew "
           "where it leaves one; 0: no wells",
           "Liffman et al. 1992, eq. 30");
  s.number("well", "-", IN(well), {1e-9, 1},
           "half width a of the wells, in diameters; smaller: stiffer",
           "Liffman et al. 1992, eq. 30");
  s.number("step", "-", IN(step), {1e-2, 100},
           "time step over (1/10) pi sqrt(m/K); longer: grains turn soft sooner, as a grain does "
           "that would be back within a step",
           "Liffman et al. 1992, eq. 22");
  s.number("rest", "-", IN(rest), kRatioOfForces,
           "mean resultant over mean contact force at which the run ends");
  s.number("max_time", "-", IN(max_time), {1e-3, 1e6},
           "in sqrt(d/g), of a drop after the last disk; ends the run as well");
  s.number("records", "-", IN(records), {2, 100000}, "points of the curves over max_time");
}

}  // namespace grainfield::coupling

#undef IN
