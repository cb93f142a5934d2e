// What a pile will take, and whether it can be set up.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/studies/pile/pile_checks.h"
#include "coupling/studies/pile/simulation.h"
#include "dem/grains/grain_family.h"
#include "dem/pouring/source.h"
#include "dem/run/common.h"
#include "dem/run/judge_draws.h"

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

}  // namespace

Outlook foresee_pile(const PileSetup& s, const std::vector<std::uint64_t>& seeds,
                     std::int64_t most) {
  check_pile(s);
  Outlook out;
  out.grains = s.source.grains;
  const double side_by_side = length_in_grains(s);
  out.fixed = s.floor.kind == "rough" ? side_by_side : 0;
  out.bytes = (out.grains + out.fixed) * (s.shape.kind == "disk" ? kBytesOfDisk : kBytesOfPolygon);
  out.bytes_key = "source.grains";

  const bool irregular = s.shape.kind == "rand1" || s.shape.kind == "irregular";
  const double density = s.material.density;
  Draws draws(most, seeds.size());
  while (draws.next()) {
    Random random(seeds[draws.at()]);
    GrainTally poured(density);
    draws.draw(s.shape, s.source.grains, random, poured);
    GrainTally all = poured;
    if (s.floor.kind == "rough") draws.fill(s.shape, s.floor.length, random, all);
    // Those that follow are like these: where they are not drawn, a little is kept in reserve.
    const bool whole = draws.all_known();
    const EngineSettings settings = engine_settings(s.material, s.motion, all.extremes(), 1,
                                                    irregular, whole ? 1 : kStepReserve);
    check_background_damping(s.rest, settings.time_step);
    if (out.time_step == 0) out.take_step(settings);
    double area = poured.area();
    if (!whole) {
      const double n = s.source.grains, drawn = static_cast<double>(poured.count());
      const double error = poured.area_variation() * (1 / std::sqrt(n) + 1 / std::sqrt(drawn));
      area = std::min(area * n / drawn * (1 + kAreaErrors * error), most_area(s));
    }
    check_source(s, (whole ? 1 : kSizeReserve) * poured.largest_radius(), area);
  }

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

Outlook foresee_changes(const ChangeSetup& change) {
  Times times;
  add_changes(change, times);
  Outlook out;
  times.put_into(out);
  return out;
}

}  // namespace grainfield::dem
