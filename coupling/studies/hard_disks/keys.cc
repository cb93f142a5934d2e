// Keys of gases of hard grains: [gas].
#include "coupling/studies/hard_disks/keys.h"

#include "coupling/case/declare.h"
#include "coupling/studies/hard_disks/simulation.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(dem::HardParticlesSetup, MEMBER)

namespace grainfield::coupling {

void declare_gas_keys(SectionKeys s) {
  constexpr const char* kLiffman = "Liffman et al. 1992, eqs 4-21";
  s.word("shape", IN(shape), {"disk", "sphere"}, "of all grains; sphere: in three dimensions");
  s.word("kind", IN(kind), {"pressure", "cooling"},
         "pressure: grains collide without loss and friction; cooling: they lose energy");
  s.number("grains", "-", IN(grains), {8, 1e7}, "more: less scatter, and as many more collisions");
  s.number("radius", "m", IN(radius), kRadius, "of all grains");
  s.number("density", "kg/m2 (3D: kg/m3)", IN(density), {1e-3, 1e6},
           "of the grains, in 2D areal; no figure depends on it");
  s.number("speed", "m/s", IN(speed), {1e-9, 1e4},
           "of each component of the velocities at the start the root of the sum of squares over "
           "N - 1: their mean is 0");
  s.number("fractions", "-", IN(fractions), {1e-4, 0.9},
           "of the periodic box that grains fill, one gas after the other; beyond 0.69 (disks) or "
           "0.49 (spheres) they crystallize, and the equations of state do not hold");
  s.number("equilibration", "-", IN(equilibration), {0, 1e6},
           "collisions a grain, without loss, before anything is measured: the lattice of the "
           "start has to go");
  s.number("collisions", "-", IN(collisions), {1, 1e8},
           "a grain, during which the pressure is measured; more: less scatter");
  s.only("gas.kind", {"pressure"});
  s.number("restitution", "-", IN(restitution), {0, 1},
           "speed of parting over that of approach, below 1; less: faster cooling, and clusters",
           kLiffman);
  s.only("gas.kind", {"cooling"});
  s.number("friction", "-", IN(friction), {0, 10},
           "Coulomb coefficient; above 0 grains begin to spin, and Haff's law has to be another",
           kLiffman);
  s.only("gas.kind", {"cooling"});
  s.number("contact_time", "s", IN(contact_time), Range{1e-12, 1}.with_zero(),
           "collisions that follow one of the same grain within it lose nothing; 0: inelastic "
           "collapse ends the run",
           "Luding and McNamara 1998");
  s.only("gas.kind", {"cooling"});
  s.number("cool_to", "-", IN(cool_to), {1e-8, 0.99},
           "share of the temperature at which Haff's law ends the run");
  s.only("gas.kind", {"cooling"});
  s.number("records", "-", IN(records), {2, 1000}, "points of the curve of cooling");
  s.only("gas.kind", {"cooling"});
}

}  // namespace grainfield::coupling

#undef IN
