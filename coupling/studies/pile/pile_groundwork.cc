#include "coupling/studies/pile/pile_groundwork.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/studies/pile/pile_checks.h"
#include "dem/pouring/source.h"
#include "dem/run/common.h"

namespace grainfield::dem {
namespace {

// Grains side by side along the floor of a pile.
constexpr double kMostOnFloor = 1e5;
// By how much the largest grain may miss that of grains that were not drawn; and standard errors of
// their total area.
constexpr double kSizeReserve = 1.1, kAreaErrors = 6;

void add_changes(const ChangeSetup& change, Times& times) {
  if (change.method != "damped") return;
  times.add("change.ramp_time", change.ramp_time * static_cast<double>(change.gravity.size()));
}

// Grains side by side on the floor, about; throws when they are too many: a rough one is made of
// them, and of a smooth one surface and stray grains are looked at in columns as wide.
double length_in_grains(const PileSetup& s) {
  const bool by_side = s.shape.kind == "irregular" && s.shape.side > 0;
  const double radius = by_side ? 0.85 * s.shape.side : s.shape.radius;
  const double count = s.floor.length / (2 * radius);
  if (count > kMostOnFloor) {
    too_many("floor.length", s.floor.length, 2 * radius * kMostOnFloor, " m",
             fmt::format("with grains of this size: {:g} of them side by side", kMostOnFloor));
  }
  return count;
}

// The area of all grains of a pile, m2: none is larger than the circle or ellipse through its
// corners.
double most_area(const PileSetup& s) {
  if (s.shape.kind == "irregular" || s.shape.kind == "outline") {
    return std::numeric_limits<double>::infinity();
  }
  // Moments of a size uniform in 1 -+ p.
  const double n = s.source.grains, p2 = s.shape.polydispersity * s.shape.polydispersity;
  const double second = 1 + p2 / 3, fourth = 1 + 2 * p2 + p2 * p2 / 5;
  const double error = std::sqrt((fourth / (second * second) - 1) / n);
  return n * disk_grain(s.shape.radius).area * second * (1 + kAreaErrors * error);
}

// The area of all grains of a pile of which these were drawn, at most, m2.
double area_ahead(const PileSetup& s, const std::vector<ShapedGrain>& drawn) {
  const double n = s.source.grains, count = static_cast<double>(drawn.size());
  const double area = total_area(drawn), mean = area / count;
  double squares = 0;
  for (const ShapedGrain& g : drawn) squares += g.area * g.area;
  const double variation = std::sqrt(std::max(0.0, squares / count - mean * mean)) / mean;
  const double error = variation * (1 / std::sqrt(n) + 1 / std::sqrt(count));
  return std::min(area * n / count * (1 + kAreaErrors * error), most_area(s));
}

}  // namespace

void PileGroundwork::check(const Setup& s) {
  check_pile(s);
  length_in_grains(s);
}

PileGrains PileGroundwork::draw(const Setup& s, Random& random, Allowance& allowance) {
  PileGrains out;
  const double work = draw_work(s.shape);
  for (int k = allowance.grant(s.source.grains, work); k > 0; --k) {
    out.poured.push_back(draw_grain(s.shape, random));
  }
  if (s.floor.kind != "rough") return out;
  for (double room = s.floor.length; allowance.grant_one(work);) {
    const ShapedGrain next = draw_grain(s.shape, random);
    room -= 2 * next.radius;
    if (room < 0) break;
    out.floor.push_back(next);
  }
  return out;
}

EngineSettings PileGroundwork::settings(const Setup& s, const PileGrains& grains, double reserve) {
  std::vector<ShapedGrain> all = grains.poured;
  all.insert(all.end(), grains.floor.begin(), grains.floor.end());
  EngineSettings out =
      engine_settings(s.material, s.motion, extremes_of(all, s.material.density), 1,
                      s.shape.kind == "rand1" || s.shape.kind == "irregular", reserve);
  check_background_damping(s.rest, out.time_step);
  const double largest = largest_radius(grains.poured);
  if (reserve > 1) {
    check_source(s, kSizeReserve * largest, area_ahead(s, grains.poured));
  } else {
    check_source(s, largest, total_area(grains.poured));
  }
  out.shape =
      (s.shape.kind != "disk" || s.source.opening > 0) ? ShapeKind::polygon : ShapeKind::disk;
  out.sleep = s.sleep;
  return out;
}

Outlook PileGroundwork::outlook(const Setup& s, const EngineSettings& settings) {
  Outlook out;
  out.take_step(settings);
  out.grains = s.source.grains;
  out.fixed = s.floor.kind == "rough" ? length_in_grains(s) : 0;
  out.bytes = (out.grains + out.fixed) * (s.shape.kind == "disk" ? kBytesOfDisk : kBytesOfPolygon);
  out.bytes_key = "source.grains";
  Times times;
  if (s.source.kind == "point") {
    times.add("source.interval", s.source.grains * s.source.interval);
  } else {
    times.add("source.clearance",
              least_interval(s.source.speed, s.material.gravity, s.source.clearance));
  }
  add_changes(s.change, times);
  times.put_into(out);
  return out;
}

Outlook foresee_pile(const PileSetup& setup, const std::vector<std::uint64_t>& seeds,
                     std::int64_t draws) {
  return foresee<PileGroundwork>(setup, seeds, draws);
}

Outlook foresee_changes(const ChangeSetup& change) {
  Times times;
  add_changes(change, times);
  Outlook out;
  times.put_into(out);
  return out;
}

}  // namespace grainfield::dem
