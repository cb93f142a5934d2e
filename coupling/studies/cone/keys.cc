// Keys of cones: [cone].
#include "coupling/studies/cone/keys.h"

#include "coupling/case/declare.h"
#include "coupling/run/grain_keys.h"
#include "coupling/studies/cone/simulation.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(dem::ConeSetup, plan.MEMBER)

namespace grainfield::coupling {
namespace {

void grains(SectionKeys& s) {
  s.word("shape", IN(shape), {"sphere", "superellipsoid"},
         "of the grains; spheres may resist rolling (material.rolling_friction), superellipsoids "
         "do by their shape");
  s.number("grains", "-", IN(grains), {50, 1e7},
           "poured; the cost grows a little faster. Those that leave the floor are taken away");
  s.number("radius", "m", IN(radius), kRadius,
           "mean radius; superellipsoids: the unit of their semi-axes");
  s.number("polydispersity", "-", IN(polydispersity), {0, 0.9},
           "half the width of the radii over their mean; more keeps crystals away");
  s.only("cone.shape", {"sphere"});
  declare_superellipsoid_keys(s, "cone.shape",
                              {IN(axis_min), IN(axis_max), IN(exponent_min), IN(exponent_max)});
}

}  // namespace

void declare_cone_keys(SectionKeys s) {
  s.word("source", IN(source), {"point", "rain", "cylinder"},
         "point: grains fall from a mouth above the apex, which rises with it; rain: from "
         "everywhere above the floor; cylinder: into a cylinder, which is then lifted",
         "Vanel 1999");
  grains(s);
  s.number("mouth", "m", IN(mouth), kLength,
           "radius of the mouth, or of the cylinder; wider: a rounder apex");
  s.only("cone.source", {"point", "cylinder"});
  s.number("rate", "1/s", IN(rate), {1e-3, 1e9},
           "grains a second, or as many as find a free place at the start; faster: less time to "
           "simulate, larger avalanches");
  s.number("drop", "m", IN(drop), kLength,
           "from the heap's top to where grains start; higher: stronger impacts");
  s.number("speed", "m/s", IN(speed), {0, 1e4},
           "downwards, at the start; faster: more grains a second find a free place");
  s.number("lift_speed", "m/s", IN(lift_speed), {1e-6, 1e4},
           "of the cylinder; slower: closer to quasi-static");
  s.only("cone.source", {"cylinder"});
  s.word("floor", IN(floor), {"rough", "smooth"},
         "fixed spheres side by side, or flat with material.floor_friction");
  s.number("floor_radius", "m", IN(floor_radius), kLength,
           "a grain whose centre is beyond has left the floor; rain falls up to here");
}

}  // namespace grainfield::coupling

#undef IN
