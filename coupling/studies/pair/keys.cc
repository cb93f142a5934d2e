// Keys of two bodies that meet: [pair].
#include "coupling/studies/pair/keys.h"

#include "coupling/case/declare.h"
#include "coupling/studies/pair/simulation.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(dem::PairSetup, MEMBER)

namespace grainfield::coupling {
namespace {

constexpr Range kTurn{-360, 360};       // deg
constexpr Range kSpeed{1e-9, 1e4};      // m/s
constexpr Range kSlant{-89.9, 89.9};    // deg
constexpr Range kSpins{-1e6, 1e6};      // rad/s
constexpr Range kDepth{1e-6, 1};        // over the radius
constexpr Range kAmplitude{1e-6, 10};   // over the radius
constexpr Range kSwing{1e-3, 3600};     // deg
constexpr Range kWaypoints{-100, 100};  // radii, rad

void bodies(SectionKeys& s) {
  s.word("shape", IN(shape), {"disk", "rand1", "regular", "outline", "sphere"},
         "of both bodies; sphere: in three dimensions");
  s.word("partner", IN(partner), {"grain", "wall"},
         "the second body: a grain at rest at the origin, or the plane wall x = 0, which never "
         "moves; with material.friction both");
  s.number("radius", "m", IN(radius), kRadius,
           "of the first body; of polygons: of the circle that the corners lie on");
  s.number("radius_second", "m", IN(radius_second), kRadius.with_zero(),
           "of the second body; 0: as the first");
  s.only("pair.partner", {"grain"});
  s.number("corners", "-", IN(corners), {3, 64}, "of each polygon");
  s.only("pair.shape", {"rand1", "regular"});
  s.number("axis_ratio", "-", IN(axis_ratio), {1, 5},
           "major over minor axis of the ellipse that carries the corners");
  s.only("pair.shape", {"rand1"});
  s.number("outline", "-", IN(outline), {-100, 100},
           "corners x1, y1, x2, y2, ... in units of the radius, in their order round the body, "
           "convex; the farthest 0.2 to 5 from the centroid");
  s.or_none();
  s.with_repeats();
  s.only("pair.shape", {"outline"});
  s.number("turned_first", "deg", IN(turned_first), kTurn,
           "angle of the first body at the start; rand1: beside the angle that is drawn");
  s.number("turned_second", "deg", IN(turned_second), kTurn, "of the second body");
  s.only("pair.partner", {"grain"});
  s.number("offset", "-", IN(offset), {-10, 10},
           "height of the first body's centroid above the x axis, over the radius; off 0 the blow "
           "is eccentric");
}

void collision(SectionKeys& s) {
  s.number("speed", "m/s", IN(speed), kSpeed.with_zero(),
           "of the first body; on a path: along it, and 0 passes it without dashpots or friction");
  s.number("angle", "deg", IN(angle), kSlant,
           "of the first body's velocity to the x axis; more: more slip");
  s.only("pair.kind", {"collision"});
  s.number("spin_first", "rad/s", IN(spin_first), kSpins,
           "of the first body before the impact: one number, of spheres three");
  s.or_none();
  s.with_repeats();
  s.only("pair.kind", {"collision"});
  s.number("spin_second", "rad/s", IN(spin_second), kSpins, "of the second body");
  s.or_none();
  s.with_repeats();
  s.only("pair.kind", {"collision"});
  s.number("speeds", "m/s", IN(speeds), kSpeed,
           "further impacts, at pair.angle: restitution against speed");
  s.or_none();
  s.only("pair.kind", {"collision"});
  s.number("angles", "deg", IN(angles), kSlant,
           "further impacts, at pair.speed: restitution against angle");
  s.or_none();
  s.only("pair.kind", {"collision"});
}

void path(SectionKeys& s) {
  s.word("path", IN(path), {"approach", "slide", "roll", "loop", "random", "waypoints"},
         "approach: to depth and back along x; slide: to and fro across the normal, round bodies "
         "about each other so that the depth stays; roll: the same without slip; loop: an ellipse "
         "with a swing; random: closed loops drawn for every pair; waypoints: straight pieces");
  s.only("pair.kind", {"path"});
  s.number("depth", "-", IN(depth), kDepth,
           "how far the first body comes beyond touching, over the radius; loop: the centre of its "
           "ellipse, so the body itself by up to pair.amplitude further");
  s.only("pair.path", {"approach", "slide", "roll", "loop"});
  s.number("amplitude", "-", IN(amplitude), kAmplitude,
           "slide: to either side; loop: half axes; over the radius");
  s.only("pair.path", {"slide", "loop"});
  s.number("swing", "deg", IN(swing), kSwing,
           "roll: angle about the contact; loop: angle of the first body, to either side");
  s.only("pair.path", {"roll", "loop"});
  s.number("turns", "-", IN(turns), {1, 1000}, "how often the path is passed to and fro");
  s.only("pair.path", {"approach", "slide", "roll"});
  s.number("steps", "-", IN(steps), {10, 100000},
           "of a path, at least: it is passed again in steps four times finer, down to a 256th, "
           "until its work changes by less than 2e-6 of the largest stored energy");
  s.only("pair.kind", {"path"});
  s.number(
      "loops", "-", IN(loops), {1, 4000},
      "random: pairs drawn, each with a loop of its own on which the outlines cross, of half axes "
      "0.05 to 0.4 of the mean radius; of rand1 every fourth pair is two bars across each other");
  s.only("pair.path", {"random"});
  s.number("waypoints", "-", IN(waypoints), kWaypoints,
           "x, y, angle, x, y, angle, ...: places of the first body from where the bodies touch, "
           "in radii, with its angle in rad; equal ends close the path");
  s.or_none();
  s.with_repeats();
  s.only("pair.path", {"waypoints"});
}

}  // namespace

void declare_pair_keys(SectionKeys s) {
  s.word("kind", IN(kind), {"collision", "path"},
         "collision: the first body flies freely against the second, without gravity; path: it is "
         "led, and the second is held");
  bodies(s);
  collision(s);
  path(s);
  s.number("records", "-", IN(records), {2, 1000},
           "rows of profiles.csv, at least so many where there are as many steps, at most twice");
}

}  // namespace grainfield::coupling

#undef IN
