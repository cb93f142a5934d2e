// Keys of piles: [shape] [source] [floor] [sleep] [change], and of what is looked at: [heap].
#include "coupling/studies/pile/keys.h"

#include "coupling/case/declare.h"
#include "coupling/specimen/setup.h"
#include "coupling/studies/pile/simulation.h"

#define IN(MEMBER) GRAINFIELD_MEMBER(dem::PileSetup, MEMBER)
#define HEAP(MEMBER) GRAINFIELD_MEMBER(HeapSetup, MEMBER)

namespace grainfield::coupling {
namespace {

constexpr const char* kRoul = "Roul table 2";

}  // namespace

void declare_shape_keys(SectionKeys s) {
  s.word("kind", IN(shape.kind), {"disk", "rand1", "regular", "irregular", "outline"},
         "disk; rand1: corners at random on a circle or ellipse; regular: regular polygons; "
         "irregular: pentagons; outline: the one given",
         "Roul 2.8");
  s.plane_shapes();
  s.number("radius", "m", IN(shape.radius), kRadius,
           "mean radius of the circle that the corners lie on (ellipse: of equal area); larger "
           "grains: longer time step",
           kRoul);
  s.number("polydispersity", "-", IN(shape.polydispersity), {0, 0.99},
           "sizes uniform in radius (1 -+ this); the smallest grain sets the time step",
           "Roul table 2 (point 0.3, line 0.1)");
  s.number("corners_min", "-", IN(shape.corners_min), {3, 64},
           "fewest corners; fewer: rougher grains", "Roul table 2 (point 6-8, line 7)");
  s.only("shape.kind", {"rand1", "regular"});
  s.number("corners_max", "-", IN(shape.corners_max), {3, 64},
           "most corners; uniform between the two", kRoul);
  s.only("shape.kind", {"rand1", "regular"});
  s.number("axis_ratio", "-", IN(shape.axis_ratio), {1, 5}, "major over minor axis of the ellipse",
           "Roul 3.1 (elliptic: 2)");
  s.only("shape.kind", {"rand1"});
  s.number("side", "m", IN(shape.side), kRadius.with_zero(),
           "mean length of a side; 0: of the regular pentagon in the circle of radius", "Roul 5.1");
  s.only("shape.kind", {"irregular"});
  s.number("outline", "-", IN(shape.outline), {-100, 100},
           "corners x1, y1, x2, y2, ... in units of radius, in their order round "
           "the grain, convex; the farthest 0.2 to 5 from the centroid");
  s.or_none();
  s.with_repeats();
  s.only("shape.kind", {"outline"});
}

void declare_source_keys(SectionKeys s) {
  s.word("kind", IN(source.kind), {"point", "line"},
         "point: grain by grain from a funnel; line: layers dropped from just above", "Roul 3.1");
  s.number("grains", "-", IN(source.grains), {3, 1e7},
           "of the pile; cost grows a little faster than this number; line: fewer when the pile "
           "comes to a point before",
           kRoul);
  s.number("height", "m", IN(source.height), kLength,
           "of the funnel's mouth above the floor; higher: faster grains at the top", kRoul);
  s.only("source.kind", {"point"});
  s.only("source.above", {"0.0"});
  s.number("above", "-", IN(source.above), Range{0.1, 1000}.with_zero(),
           "each grain starts this many mean diameters above the pile's top as it is then; 0: from "
           "source.height",
           "Liffman et al. 1992, fig. 20: 2");
  s.only("source.kind", {"point"});
  s.number("speed", "m/s", IN(source.speed), {0, 1e4}, "downwards, at the start", kRoul);
  s.number("interval", "s", IN(source.interval), kTime,
           "from one grain to the next; longer: each grain comes to rest before the next, "
           "and the pouring takes as much longer",
           kRoul);
  s.only("source.kind", {"point"});
  s.number("spread", "-", IN(source.spread), {0, 1000},
           "without a funnel of plates: grains start within +- this many mean radii of the axis");
  s.only("source.kind", {"point"});
  s.number(
      "opening", "m", IN(source.opening), kLength.with_zero(),
      "width of the funnel's mouth between two immobile plates at 60 degrees, down which the "
      "grains come from anywhere between their upper ends; 0: no plates, they fall freely from "
      "the mouth (and cost less)");
  s.only("source.kind", {"point"});
  s.number("move", "m", IN(source.move), kOffset,
           "the funnel moves this far to the right while it pours; an asymmetric pile",
           "Roul 3.11");
  s.only("source.kind", {"point"});
  s.number("clearance", "m", IN(source.clearance), kLength,
           "height above the pile from which a layer falls", kRoul);
  s.only("source.kind", {"line"});
  s.number("length", "m", IN(source.length), kLength,
           "of the first layer; later ones are as long as the pile's plateau. Pouring ends when "
           "it has come to a point: about 0.7 of the finished pile's base fits all grains",
           "Roul 3.1");
  s.only("source.kind", {"line"});
  s.number("shift", "m", IN(source.shift), kOffset,
           "every layer's middle lies this far to the right of the last one's; an asymmetric "
           "pile, steeper on the right; below 0: to the left",
           "Roul 3.11");
  s.only("source.kind", {"line"});
  s.number("record", "-", IN(record), {1, 1e7},
           "whole numbers of grains, each above the last: a snapshot poured_N is left of the pile "
           "as it is when N are poured; more: a larger snapshots.h5");
  s.or_none();
}

void declare_floor_keys(SectionKeys s) {
  s.word("kind", IN(floor.kind), {"smooth", "rough"},
         "flat with material.floor_friction, or grains of the pile's kind fixed side by side",
         "Roul 3.1");
  s.number("length", "m", IN(floor.length), kLength,
           "of the floor; a pile that leans on the walls at its ends is refused");
}

void declare_sleep_keys(SectionKeys s) {
  s.flag("on", IN(sleep.on),
         "grains at rest sleep while the pile is poured: the cost follows the moving ones; the "
         "final state is always relaxed with every grain awake");
  s.number("quiet_time", "s", IN(sleep.quiet_time), kTime,
           "a grain must be quiet this long before it sleeps; longer: fewer errors, dearer");
  s.only("sleep.on", {"true"});
  s.number("quiet_move", "-", IN(sleep.quiet_move), {1e-12, 1e3},
           "quiet: moved less than this share of its diameter in quiet_time, against what it "
           "touches");
  s.only("sleep.on", {"true"});
  s.number("quiet_creep", "1/s", IN(sleep.quiet_creep), {1e-12, 1e6},
           "sleeps: has crept by less than so many diameters a second since it is quiet, likewise");
  s.only("sleep.on", {"true"});
  s.number("quiet_force", "-", IN(sleep.quiet_force), {1e-12, 1e3},
           "sleeps: out of balance by less than this share of its load, half the sum of the "
           "lengths of all forces on it; 1e-12: none sleeps");
  s.only("sleep.on", {"true"});
  s.number("wake_force", "-", IN(sleep.wake_force), {1e-12, 1e3},
           "wakes: out of balance by more than this share of its load in the mean over wake_time; "
           "less wakes more");
  s.only("sleep.on", {"true"});
  s.number("wake_time", "s", IN(sleep.wake_time), kTime,
           "over which that is taken: an elastic wave that passes wakes nobody; below 50 steps: "
           "these");
  s.only("sleep.on", {"true"});
  s.number("wake_shock", "-", IN(sleep.wake_shock), {1e-12, 1e3},
           "wakes: out of balance by more than this share of its load in the mean over 50 steps");
  s.only("sleep.on", {"true"});
  s.number(
      "wake_levels", "-", IN(sleep.wake_levels), {1e-12, 1e3},
      "wakes all, for wake_time: the force that the sleepers above a level pass on to it differs "
      "from the weight above by more than this share of it; 1000: never");
  s.only("sleep.on", {"true"});
  s.number("wake_speed", "-", IN(sleep.wake_speed), {1e-6, 1e6},
           "wakes: touched at more than this times sqrt(g d)");
  s.only("sleep.on", {"true"});
  s.number("wake_reach", "-", IN(sleep.wake_reach), {0, 1e3},
           "wakes: within this times d v / sqrt(g d) of a grain that comes near at such a speed v; "
           "0: only what it touches, and impacts hardly move the pile");
  s.only("sleep.on", {"true"});
}

void declare_change_keys(SectionKeys s) {
  s.number("gravity", "m/s2", IN(change.gravity), kAcceleration,
           "after the rest gravity is changed to each of these, slowly, always from "
           "material.gravity; [] changes nothing (pile-fields: takes 10 % away)",
           "Roul 3.5-3.9");
  s.or_none();
  s.word("method", IN(change.method), {"newton", "damped"},
         "quasi-static solver on the contact network, or slow damped dynamics");
  s.number("unbalanced_force_ratio", "-", IN(change.unbalanced_force_ratio), kRatioOfForces,
           "mean resultant over mean contact force to be reached");
  s.only("change.method", {"newton"});
  s.number("ramp_time", "s", IN(change.ramp_time), kTime,
           "from the old to the new gravity; longer is closer to quasi-static");
  s.only("change.method", {"damped"});
}

void declare_heap_keys(SectionKeys s) {
  s.number("heights", "-", HEAP(heights), {1e-6, 1},
           "horizontal cuts, as shares of the pile's height above the base; the base is always "
           "added",
           "Roul 3.3");
  s.number("centre", "-", HEAP(centre), {1e-6, 1},
           "dip and stress on the axis: their windows under the apex are |x| up to this share of "
           "the half base; wider is less noisy and blurs a narrow dip");
  s.number("shoulder_from", "-", HEAP(shoulder_from), {0, 1},
           "dip: the windows beside it begin here, shares of the half base");
  s.number("shoulder_to", "-", HEAP(shoulder_to), {1e-6, 1}, "and end here");
  s.number("axis_from", "-", HEAP(axis_from), {0, 1},
           "stress on the axis: its window begins here, share of the height above the base");
  s.number("axis_to", "-", HEAP(axis_to), {1e-6, 1},
           "and ends here; higher: fewer and fainter contacts under the apex");
}

}  // namespace grainfield::coupling

#undef HEAP
#undef IN
