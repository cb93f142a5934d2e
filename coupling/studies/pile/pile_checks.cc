#include "coupling/studies/pile/pile_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/specimen/surface.h"
#include "coupling/studies/pile/simulation.h"
#include "dem/engine/engine.h"
#include "dem/grains/placed.h"
#include "dem/pouring/funnel.h"
#include "dem/pouring/source.h"
#include "dem/run/common.h"
#include "dem/shared/refuse.h"

namespace grainfield::dem {
namespace {

constexpr double kExpectedVolumeFraction = 0.8;
constexpr double kExpectedSlope = std::numbers::inv_sqrt3;  // 30 degrees
// The floor reaches this much beyond the expected heap: slopes differ, grains roll off.
constexpr double kFloorReserve = 1.25;
// A line holds the grains of the expected heap on its length and this much more, because grains
// that roll off its ends widen the heap.
constexpr double kLineReserve = 2.5;
constexpr double kMostNotPoured = 0.2;
// s; a free fall through the largest funnel that makes sense takes a part of it.
constexpr double kMostWaiting = 2;
// Shares of the pile's weight, and what a few strays that rolled to the wall may press on it
// besides.
constexpr double kMostLean = 1e-3, kStrays = 3, kMostOfStrays = 4e-3;

// To three digits, never down: the value that a message names must be accepted.
double round_up(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::ceil(value / unit * (1 - 1e-12)) * unit;
}

// 1 for the free grains that a wall or the floor's grains carry, through others too, and that are
// slower than a fall over their own diameter: not for those in the air, nor for those on a funnel's
// plates (fixed, above the floor) or stuck between these.
std::vector<char> standing(const Snapshot& s) {
  std::vector<char> stands(s.grains.size(), 0);
  std::vector<std::vector<std::int64_t>> beside(s.grains.size());
  std::vector<std::int64_t> next;
  const auto plate = [&s](std::int64_t g) {
    return g >= 0 && s.grains[g].fixed && s.grains[g].position.y() > 0;
  };
  const auto reach = [&](std::int64_t g) {
    if (stands[g]) return;
    stands[g] = 1;
    next.push_back(g);
  };
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    const auto g = static_cast<std::int64_t>(k);
    if (s.grains[k].fixed && !plate(g)) reach(g);
  }
  for (const Contact& c : s.contacts) {
    if (plate(c.i) || plate(c.j)) continue;
    if (c.j < 0) {
      reach(c.i);
    } else {
      beside[c.i].push_back(c.j);
      beside[c.j].push_back(c.i);
    }
  }
  while (!next.empty()) {
    const std::int64_t g = next.back();
    next.pop_back();
    for (const std::int64_t other : beside[g]) reach(other);
  }
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    const Grain& g = s.grains[k];
    const double slow = 2 * std::fabs(s.gravity.y()) * 2 * g.radius;
    if (g.fixed || g.velocity.squaredNorm() > slow) stands[k] = 0;
  }
  return stands;
}

// The diameter of any grain of a family whose outline is not given otherwise, m: no later
// realization is refused what the first one may.
double largest_diameter(const ShapeSetup& s) {
  if (s.kind == "irregular" || s.kind == "outline") return 0;
  // From its centroid a corner of RAND1 may be farther than from the ellipse's middle: triangles by
  // 21 % at most in 100,000, others less.
  const double off_centre = s.kind == "rand1" ? 1.21 : 1;
  return off_centre * 2 * s.radius * (1 + s.polydispersity) * std::sqrt(s.axis_ratio);
}

void check_funnel(const SourceSetup& s, double diameter, double floor) {
  if (s.opening == 0) return;
  require(s.opening >= kLeastOpening * diameter, "source.opening", s.opening,
          fmt::format("0 (no funnel) or at least {:g} m, {:g} of the largest diameters, or the "
                      "grains jam; raise source.opening",
                      round_up(kLeastOpening * diameter), kLeastOpening));
  require(funnel_half_span(s) <= 0.5 * floor, "source.opening", s.opening,
          fmt::format("a funnel (2.7 openings either side with its plates) above the floor of "
                      "{:g} m; lower source.opening or raise floor.length",
                      floor));
}

}  // namespace

ExpectedHeap expected_heap(double grain_area) {
  const double area = grain_area / kExpectedVolumeFraction;
  return {std::sqrt(area * kExpectedSlope), 2 * std::sqrt(area / kExpectedSlope)};
}

void check_pile(const PileSetup& s) {
  check_shape(s.shape);
  require(s.source.opening == 0 || s.source.above == 0, "source.above", s.source.above,
          "0 with a funnel of plates (source.opening), whose mouth does not rise");
  const double usual = SourceSetup{}.spread;
  require(s.source.opening == 0 || s.source.spread == usual, "source.spread", s.source.spread,
          fmt::format("{:g} with a funnel of plates (source.opening), between which grains start "
                      "anywhere",
                      usual));
  require(s.source.opening == 0 || s.source.move == 0, "source.move", s.source.move,
          "0 with a funnel of plates (source.opening), which cannot move");
  if (s.source.kind == "point") {
    require(s.source.shift == 0, "source.shift", s.source.shift,
            "0 with source.kind \"point\", whose funnel moves by source.move");
  } else {
    require(std::fabs(s.source.shift) <= 0.5 * s.source.length, "source.shift", s.source.shift,
            fmt::format("at most half of source.length, {:g} m, either way: a layer falls on the "
                        "last one",
                        0.5 * s.source.length));
    require(s.source.opening == 0, "source.opening", s.source.opening,
            "0 with source.kind \"line\"");
    require(s.source.move == 0, "source.move", s.source.move,
            "0 with source.kind \"line\", whose layers move by source.shift");
  }
  if (RollingLaw::of(s.material).on()) {
    require(s.source.opening == 0, "source.opening", s.source.opening,
            "0 with material.rolling_friction: beside a funnel's plates grains are polygons");
  }
  for (std::size_t k = 0; k < s.record.size(); ++k) {
    const double before = k == 0 ? 0 : s.record[k - 1];
    require(s.record[k] == std::floor(s.record[k]) && s.record[k] > before &&
                s.record[k] <= s.source.grains,
            "source.record", s.record[k],
            fmt::format("whole numbers of grains up to source.grains = {}, each above the last",
                        s.source.grains));
  }
  if (!s.change.gravity.empty()) {
    check_method("change.method", s.change.method, s.material, s.motion);
  }
  for (std::size_t k = 0; k < s.change.gravity.size(); ++k) {
    const double g = s.change.gravity[k];
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      require(fmt::format("{:g}", s.change.gravity[earlier]) != fmt::format("{:g}", g),
              "change.gravity", g, "every value once");
    }
  }
}

void check_source(const PileSetup& s, double largest_radius, double grain_area) {
  const double diameter = 2 * largest_radius;
  const ExpectedHeap heap = expected_heap(grain_area);
  double base = heap.base;
  if (s.source.kind == "point") {
    const double interval = least_interval(s.source.speed, s.material.gravity, diameter);
    require(s.source.interval >= interval, "source.interval", s.source.interval,
            fmt::format("at least {:g} s, or the next grain leaves the source before the last "
                        "one has cleared it by a largest diameter of {:.3g} m; raise "
                        "source.interval or source.speed",
                        round_up(interval), diameter));
    const double height = s.source.above > 0 ? 0 : heap.height + 2 * diameter;
    require(s.source.height >= height, "source.height", s.source.height,
            fmt::format("at least {:g} m, above the pile that {} grains make (30 degrees, volume "
                        "fraction 0.8); raise source.height or lower source.grains",
                        round_up(height), s.source.grains));
    check_funnel(s.source, std::max(diameter, largest_diameter(s.shape)), s.floor.length);
    base += std::fabs(s.source.move);
  } else {
    const double length = std::max(heap.base / std::sqrt(kLineReserve), 4 * diameter);
    require(s.source.length >= length, "source.length", s.source.length,
            fmt::format("at least {:g} m: on a shorter line {} grains pile up to a point before "
                        "all are poured; raise source.length or lower source.grains",
                        round_up(length), s.source.grains));
    base = std::max(base, s.source.length);
  }
  const double floor = kFloorReserve * base + 2 * diameter;
  const bool by_line = s.source.kind == "line" && base > heap.base;
  const std::string why =
      by_line
          ? fmt::format("m for source.length = {:g} m; raise floor.length or lower source.length",
                        s.source.length)
          : fmt::format(
                "m, or the pile of {} grains runs off its floor; raise floor.length or "
                "lower source.grains",
                s.source.grains);
  require(s.floor.length >= floor, "floor.length", s.floor.length,
          fmt::format("at least {:g} {}", round_up(floor), why));
}

double resting_top(const Snapshot& s, double mouth) {
  const std::vector<char> stands = standing(s);
  double top = 0;
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    if (stands[k] && s.grains[k].position.y() < mouth) top = std::max(top, top_of(s.grains[k]));
  }
  return top;
}

double pile_top(const Snapshot& s) {
  const std::vector<char> stands = standing(s);
  double top = 0;
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    const Grain& g = s.grains[k];
    const bool hops = !g.fixed && g.velocity.squaredNorm() < std::fabs(s.gravity.y()) * g.radius;
    if (stands[k] || hops) top = std::max(top, top_of(g));
  }
  return top;
}

void check_mouth(const PileSetup& setup, double top, double diameter) {
  if (top + 2 * diameter < setup.source.height) return;
  throw ComputationFailed(
      fmt::format("the pile, {:.3g} m high, has reached the mouth of the source at source.height = "
                  "{:g} m; raise source.height or lower source.grains",
                  top, setup.source.height));
}

void check_not_waiting(const PileSetup& setup, double waited) {
  if (setup.source.opening == 0 || waited <= kMostWaiting) return;
  throw ComputationFailed(
      fmt::format("grains are stuck in the funnel: the next one has waited {:.2g} s for its place "
                  "at the top; raise source.opening, now {:g} m, or source.interval",
                  waited, setup.source.opening));
}

void check_funnel_empty(const PileSetup& setup, const Snapshot& snapshot) {
  if (setup.source.opening == 0) return;
  const auto stuck = std::count_if(
      snapshot.grains.begin(), snapshot.grains.end(),
      [&](const Grain& g) { return !g.fixed && g.position.y() > setup.source.height; });
  if (stuck == 0) return;
  throw ComputationFailed(fmt::format(
      "{} grain{} stuck in the funnel after the pour; raise source.opening, now {:g} m, or "
      "source.interval",
      stuck, stuck == 1 ? " is" : "s are", setup.source.opening));
}

void check_walls_free(const PileSetup& setup, const Snapshot& snapshot, double diameter,
                      double share) {
  const double reach = 0.5 * setup.floor.length - diameter;
  const std::vector<char> stands = standing(snapshot);
  for (std::size_t k = 0; k < snapshot.grains.size(); ++k) {
    const Vec3& x = snapshot.grains[k].position;
    if (!stands[k] || std::fabs(x.x()) < reach || x.y() < 2.5 * diameter) continue;
    throw ComputationFailed(fmt::format(
        "the pile runs off its floor: it stands at a side wall after {:.0f} % of source.grains; "
        "raise floor.length, now {:g} m, to at least {:g} m, or lower source.grains",
        100 * share, setup.floor.length, round_up(1.2 * setup.floor.length / std::sqrt(share))));
  }
}

void check_not_leaning(const PileSetup& setup, const Snapshot& snapshot) {
  double lean = 0, weight = 0, grains = 0;
  for (const Contact& c : snapshot.contacts) {
    if (c.j < 0 && snapshot.walls[-1 - c.j].name != "floor") lean += std::fabs(c.force.x());
  }
  for (const Grain& g : snapshot.grains) {
    if (g.fixed) continue;
    weight += g.mass * std::fabs(snapshot.gravity.y());
    ++grains;
  }
  const double allowed = kMostLean + std::min(kStrays / grains, kMostOfStrays);
  if (lean <= allowed * weight) return;
  throw ComputationFailed(fmt::format(
      "the pile leans on the side walls with {:.2g} of its weight (allowed: {:.2g}); raise "
      "floor.length, now {:g} m, to at least {:g} m, or lower source.grains",
      lean / weight, allowed, setup.floor.length, round_up(1.2 * setup.floor.length)));
}

void check_line_long_enough(const PileSetup& setup, int poured) {
  const double share = static_cast<double>(poured) / setup.source.grains;
  if (share >= 1 - kMostNotPoured) return;
  throw ComputationFailed(fmt::format(
      "the pile came to a point after {} of {} grains; raise source.length, now {:g} "
      "m, to at least {:g} m, or lower source.grains",
      poured, setup.source.grains, setup.source.length, setup.source.length / std::sqrt(share)));
}

}  // namespace grainfield::dem
