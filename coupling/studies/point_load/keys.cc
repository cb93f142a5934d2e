// Keys of loaded layers: [packing] [load].
#include "coupling/studies/point_load/keys.h"

#include "coupling/case/declare.h"
#include "coupling/run/grain_keys.h"
#include "coupling/studies/point_load/simulation.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(dem::PointLoadSetup, MEMBER)

namespace grainfield::coupling {
namespace {

constexpr const char* kRoul = "Roul table 5.1";

}  // namespace

void declare_packing_keys(SectionKeys s) {
  s.number("dim", "-", IN(packing.dim), {2, 3},
           "dimensions: disks and pentagons in the plane, or spheres in space, up along z");
  s.word("kind", IN(packing.kind), {"triangular", "sqrt3", "layered", "close_packed", "random"},
         "how the layer is built: triangular lattice, lattice whose rows are shifted by half a "
         "spacing of sqrt(3) diameters, or rows dropped one after another; of spheres: close "
         "packed layers, or placed at random, apart from each other, and left to settle",
         "Roul 5.2, 5.4");
  s.words_of_dimensions({"triangular", "sqrt3", "layered"}, {"close_packed", "random"});
  s.word("stacking", IN(packing.stacking), {"fcc", "hcp"},
         "order of the close packed layers: ABC or AB");
  s.space();
  s.only("packing.kind", {"close_packed"});
  s.word("sizes", IN(packing.sizes), {"mono", "bidisperse", "uniform"},
         "radii: all equal, two sizes, or uniform between radius_min and radius_max", kRoul);
  s.number("radius", "m", IN(packing.radius), kRadius,
           "radius of mono and of the larger bidisperse grains; larger grains: fewer of them and a "
           "longer time step",
           kRoul);
  s.only("packing.sizes", {"mono", "bidisperse"});
  s.number("radius_small", "m", IN(packing.radius_small), kRadius,
           "radius of the smaller bidisperse grains", kRoul);
  s.only("packing.sizes", {"bidisperse"});
  s.number("fraction_small", "-", IN(packing.fraction_small), {0, 1},
           "share by number of the smaller bidisperse grains; 0 and 1 are mono-disperse");
  s.only("packing.sizes", {"bidisperse"});
  s.number("radius_min", "m", IN(packing.radius_min), kRadius,
           "smallest radius of uniform sizes; it sets the time step", kRoul);
  s.only("packing.sizes", {"uniform"});
  s.number("radius_max", "m", IN(packing.radius_max), kRadius, "largest radius of uniform sizes",
           kRoul);
  s.only("packing.sizes", {"uniform"});
  s.number("columns", "-", IN(packing.columns), {2, 100000},
           "grains in a row; more moves the side walls away from the load; of close packed layers "
           "the rows are as many as make them square",
           kRoul);
  s.only("packing.kind", {"triangular", "sqrt3", "close_packed"});
  s.number("rows", "-", IN(packing.rows), {1, 100000},
           "rows of grains, in space close packed layers; more makes the layer deeper", kRoul);
  s.only("packing.kind", {"triangular", "sqrt3", "close_packed"});
  s.number("spacing", "-", IN(packing.spacing), {0.71, 1},
           "distance of neighbours in a row over sqrt(3) diameters; below 1 rows two apart do "
           "not touch and a grain has four contacts; in space over one diameter, from 0.9: below 1 "
           "neighbours in a layer press on each other, at 1 they touch without force",
           "Roul 5.4");
  s.only("packing.kind", {"sqrt3", "close_packed"});
  s.number("width", "m", IN(packing.width), kLength,
           "distance of the side walls, or the periodic length along x and y; four depths keep "
           "their influence small",
           kRoul);
  s.only("packing.kind", {"layered", "random"});
  s.number(
      "depth", "m", IN(packing.depth), kLength,
      "rows are dropped until the surface is this high; of spheres, as many are placed as fill "
      "it at a solid fraction of 0.55",
      kRoul);
  s.only("packing.kind", {"layered", "random"});
  s.word("sides", IN(packing.sides), {"periodic", "walls"},
         "what bounds a layer of spheres along x and y");
  s.space();
  s.number("drop_height", "m", IN(packing.drop_height), kLength,
           "height above the surface from which a row falls; higher packs denser",
           "Roul table 2 (line source)");
  s.only("packing.kind", {"layered"});
  s.word("shape", IN(packing.shape), {"disk", "regular", "irregular", "superellipsoid"},
         "disks, in space spheres; regular polygons, turned at random; irregular pentagons, in "
         "dropped rows (sizes and radii are not used); or superellipsoids, whose semi-axes are "
         "over a radius drawn as packing.sizes says",
         "Roul 5.1");
  s.words_of_dimensions({"regular", "irregular"}, {"superellipsoid"});
  s.only("packing.kind", {"layered", "random", "triangular", "sqrt3"});
  s.number("corners", "-", IN(packing.corners), {3, 64},
           "corners of regular polygons, on the circle of the radius; more is rounder, and slower",
           "Roul 5.1");
  s.only("packing.shape", {"regular"});
  declare_superellipsoid_keys(s, "packing.shape",
                              {IN(packing.axis_min), IN(packing.axis_max), IN(packing.exponent_min),
                               IN(packing.exponent_max)});
  s.number("side", "m", IN(packing.side), kRadius, "mean length of a side", "Roul 5.1");
  s.only("packing.shape", {"irregular"});
  s.word("floor", IN(packing.floor), {"smooth", "rough"},
         "flat wall with friction, or a row (in space a layer) of fixed grains", "Roul 5.5");
  s.number("jitter", "-", IN(packing.jitter), {0, 0.5},
           "radii uniform in radius * [1 - 2 jitter, 1]; 0 is the perfect lattice");
  s.only("packing.sizes", {"mono"});
}

void declare_load_keys(SectionKeys s) {
  s.word("rest", IN(load.rest), {"damped", "newton"},
         "how the layer comes to rest before the load: by slow damped dynamics, or by these until "
         "rest.kinetic_to_elastic_energy is met and then by the quasi-static solver, which lowers "
         "the forces to rest.unbalanced_force_ratio; where it fails damped dynamics go on");
  s.number("force", "N", IN(load.force), kForce,
           "downwards on one grain of the surface; more rearranges grains; in space where "
           "load.weights is 0",
           kRoul);
  s.number("weights", "-", IN(load.weights), Range{1e-6, 1e9}.with_zero(),
           "the force over the mean weight of a grain; 0: load.force");
  s.space();
  s.word("method", IN(load.method), {"damped", "newton"},
         "slow damped dynamics, or the quasi-static solver on the contact network (for small "
         "forces: it fails where many contacts rearrange)");
  s.number("unbalanced_force_ratio", "-", IN(load.unbalanced_force_ratio), kRatioOfForces,
           "mean resultant over mean contact force that Newton's method must reach");
  s.only("load.method", {"newton"});
  s.word("control", IN(load.control), {"force", "speed"},
         "the force rises along a smooth ramp; or a piston comes down on the grain at load.speed "
         "until it resists with load.force, which then stays (piston.h: the piston is as stiff as "
         "material.young or normal_stiffness)",
         "Roul 5.1");
  s.words_of_dimensions({"speed"}, {});
  s.only("load.method", {"damped"});
  s.number("speed", "m/s", IN(load.speed), {1e-6, 100},
           "of the piston; slower is closer to quasi-static", kRoul);
  s.only("load.control", {"speed"});
  s.number("ramp_time", "s", IN(load.ramp_time), kTime,
           "from no force to the full one; longer is closer to quasi-static", "Roul 5.2");
  s.only("load.method", {"damped"});
  s.only("load.control", {"force"});
  s.number(
      "position", "-", IN(load.position), {0, 1},
      "share of the width: the top grain nearest to it carries the force, in space the highest "
      "within two diameters");
  s.number("position_y", "-", IN(load.position_y), {0, 1}, "likewise along y");
  s.space();
  s.number(
      "radius", "m", IN(load.radius), kLength.with_zero(),
      "the grains that are seen from above within this distance of that one share the force in "
      "equal parts; 0: it alone");
  s.space();
  s.number("probe_strain", "-", IN(load.probe_strain), Range{1e-9, 1e-4}.with_zero(),
           "size of small uniform strains of the layer before it is loaded, in six directions, "
           "forth and back, by the quasi-static solver: its moduli predict the response (model "
           "predicted); 1e-6 is good; 0: none");
  s.space();
}

}  // namespace grainfield::coupling

#undef IN
