#include "dem/study/outlook.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "dem/heap/grain_family.h"
#include "dem/heap/source.h"
#include "dem/packing/lattice_pile.h"
#include "dem/packing/packing.h"
#include "dem/packing/space_layer.h"
#include "dem/study/common.h"
#include "dem/study/judge_draws.h"
#include "dem/study/pile_checks.h"
#include "dem/study/point_load_space.h"

namespace grainfield::dem {
namespace {

// Memory of a grain with its contacts, its place in checkpoints and snapshots; half a million disks
// of a lattice take 2.3 kB each.
constexpr double kBytesOfDisk = 2500, kBytesOfPolygon = 4000, kBytesOfSphere = 4000;
// Volume fraction of a layer of dropped rows, about.
constexpr double kLayerFraction = 0.85;
// Grains side by side along the floor of a pile.
constexpr double kMostOnFloor = 1e5;
// By how much the largest grain may miss that of grains that were not drawn; and standard errors of
// their total area.
constexpr double kSizeReserve = 1.1, kAreaErrors = 6;

[[noreturn]] void too_many(const std::string& key, double found, double most,
                           const std::string& unit, const std::string& why) {
  throw std::invalid_argument(fmt::format("{}: found {:g}{}, allowed: up to {:g}{} {}", key, found,
                                          unit, round_down(most), unit, why));
}

std::string ten_million() { return fmt::format("{:g} million grains", kMostGrains * 1e-6); }

// Adds a part of the time; the key of the largest part is the one to name.
class Times {
 public:
  void add(const std::string& key, double time) {
    sum_ += time;
    if (time <= most_) return;
    most_ = time;
    key_ = key;
  }
  void put_into(Outlook& out) const {
    out.time = sum_;
    out.time_key = key_;
  }

 private:
  double sum_ = 0, most_ = 0;
  std::string key_;
};

void add_changes(const ChangeSetup& change, Times& times) {
  if (change.method != "damped") return;
  times.add("change.ramp_time", change.ramp_time * static_cast<double>(change.gravity.size()));
}

// Grains of a layer; throws when they are too many.
double grains_of(const PackingSetup& p) {
  if (p.kind != "layered") {
    // Every other row has one grain less.
    const double shifted = p.floor == "rough" ? (p.rows + 1) / 2 : p.rows / 2;
    const double count = static_cast<double>(p.columns) * p.rows - shifted;
    if (count > kMostGrains) {
      const bool rows = p.rows > p.columns;
      too_many(rows ? "packing.rows" : "packing.columns", rows ? p.rows : p.columns,
               std::floor(kMostGrains / (rows ? p.columns : p.rows)), "",
               fmt::format("with packing.{} = {}: {}", rows ? "columns" : "rows",
                           rows ? p.columns : p.rows, ten_million()));
    }
    return count;
  }
  const double r = mean_radius(p);
  const double count = draws_pentagons(p)
                           ? pentagons_drawn(p)
                           : kLayerFraction * p.width * p.depth / (std::numbers::pi * r * r);
  if (count > kMostGrains) {
    // The side that is farther from usual is the one to change.
    const PackingSetup usual;
    const bool deep = p.depth / usual.depth > p.width / usual.width;
    const double found = deep ? p.depth : p.width;
    too_many(deep ? "packing.depth" : "packing.width", found, found * kMostGrains / count, " m",
             fmt::format("with packing.{} = {:g} m and grains of this size: {}",
                         deep ? "width" : "depth", deep ? p.width : p.depth, ten_million()));
  }
  return count;
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

// Of all grains of a pile, m2: none is larger than the circle or ellipse that carries its corners.
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

// Draws the grains of one realization after the other, at most so many in all.
class Draws {
 public:
  Draws(std::int64_t most, std::size_t realizations)
      : left_(static_cast<double>(most)), realizations_(realizations) {}

  /// Goes on to the next realization that can be drawn.
  bool next() {
    if (cut_ || (at_ >= 0 && left_ <= 0)) return false;
    return static_cast<std::size_t>(++at_) < realizations_;
  }
  std::size_t at() const { return static_cast<std::size_t>(at_); }
  /// Whether this realization is whole and another one can follow, or none is left.
  bool all_known() const { return !cut_ && (left_ > 0 || at() + 1 == realizations_); }

  /// `count` grains, or as many as are left; one at least.
  void draw(const ShapeSetup& shape, double count, Random& random, GrainTally& tally) {
    const double work = draw_work(shape);
    for (double k = 0; k < count; ++k) {
      if (left_ < work && k > 0) {
        cut_ = true;
        return;
      }
      tally.add(draw_grain(shape, random));
      left_ -= work;
    }
  }
  /// Side by side on a length.
  void fill(const ShapeSetup& shape, double room, Random& random, GrainTally& tally) {
    const double work = draw_work(shape);
    for (; left_ >= work; left_ -= work) {
      const ShapedGrain next = draw_grain(shape, random);
      room -= 2 * next.radius;
      if (room < 0) return;
      tally.add(next);
    }
    cut_ = true;
  }

 private:
  double left_;
  std::int64_t at_ = -1;
  std::size_t realizations_;
  bool cut_ = false;  // in the midst of a realization
};

// Throws for more spheres than anyone's machine takes.
void check_spheres(const PackingSetup& p) {
  const double count = layer_spheres(p);
  if (count <= kMostGrains) return;
  if (p.kind == "close_packed") {
    too_many("packing.rows", p.rows, std::floor(p.rows * kMostGrains / count), "",
             fmt::format("with packing.columns = {}: {}", p.columns, ten_million()));
  }
  too_many("packing.width", p.width, p.width * std::sqrt(kMostGrains / count), " m",
           fmt::format("with packing.depth = {:g} m and grains of this size: {}", p.depth,
                       ten_million()));
}

Outlook foresee_space_load(const PointLoadSetup& s, const std::vector<std::uint64_t>& seeds,
                           std::int64_t most) {
  const PackingSetup& p = s.packing;
  Outlook out;
  check_spheres(p);
  if (!is_angular(p)) {
    out.take_step(space_load_settings(s, 1));
  } else {
    const auto draw = [&](Random& random, std::int64_t& left) {
      std::vector<ShapedGrain> shapes;
      for (const NewGrain& g : space_floor(p, s.material.density, random)) {
        shapes.emplace_back().axes = g.axes;
      }
      const std::vector<ShapedGrain> grains = draw_layer(p, random, left);
      left -= static_cast<std::int64_t>(grains.size());
      shapes.insert(shapes.end(), grains.begin(), grains.end());
      return shapes;
    };
    judge_draws(seeds, most, draw, [&](const std::vector<ShapedGrain>& shapes, double reserve) {
      const EngineSettings settings = space_load_settings(s, 1, shapes, reserve);
      if (out.time_step == 0) out.take_step(settings);
    });
  }
  out.grains = std::ceil(layer_spheres(p));
  out.fixed = floor_spheres(p);
  out.bytes = (out.grains + out.fixed) * kBytesOfSphere;
  out.bytes_key = p.kind == "random" ? "packing.width" : "packing.columns";
  Times times;
  if (p.kind == "random") {
    times.add("packing.depth", std::sqrt(2 * loose_height(p) / s.material.gravity));
  }
  times.add("load.ramp_time", s.load.ramp_time);
  times.put_into(out);
  return out;
}

}  // namespace

Outlook foresee_point_load(const PointLoadSetup& s, const std::vector<std::uint64_t>& seeds,
                           std::int64_t most) {
  const PackingSetup& p = s.packing;
  check_packing(p);
  if (p.dim == 3) return foresee_space_load(s, seeds, most);
  check_method("load.method", s.load.method, s.material, s.motion);
  Outlook out;
  out.grains = grains_of(p);
  const double radius = mean_radius(p);
  if (p.floor == "rough") out.fixed = std::floor(0.5 * layer_width(p) / radius);
  out.bytes = (out.grains + out.fixed) * (draws_pentagons(p) ? kBytesOfPolygon : kBytesOfDisk);
  out.bytes_key = p.kind == "layered"  ? "packing.width"
                  : p.rows > p.columns ? "packing.rows"
                                       : "packing.columns";

  const auto judge = [&](const GrainExtremes& extremes, double reserve) {
    const EngineSettings settings =
        engine_settings(s.material, s.motion, extremes, 1, draws_pentagons(p), reserve);
    check_background_damping(s.rest, settings.time_step);
    if (out.time_step == 0) out.take_step(settings);
  };
  if (draws_pentagons(p)) {
    Draws draws(most, seeds.size());
    while (draws.next()) {
      Random random(seeds[draws.at()]);
      GrainTally one(s.material.density);
      draws.draw(pentagon(p), pentagons_drawn(p), random, one);
      judge(one.extremes(), draws.all_known() ? 1 : kStepReserve);
    }
  } else {
    GrainExtremes extremes;
    extremes.least_mass = s.material.density * disk_grain(smallest_radius(p)).area;
    judge(extremes, 1);
  }

  Times times;
  if (p.kind == "layered") {
    const double rows = p.depth / (2 * radius);
    const double fall = 1.5 * std::sqrt(2 * (p.drop_height + 2 * radius) / s.material.gravity);
    times.add(p.drop_height > p.depth ? "packing.drop_height" : "packing.depth", rows * fall);
  }
  if (s.load.method == "damped") times.add("load.ramp_time", s.load.ramp_time);
  times.put_into(out);
  return out;
}

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

Outlook foresee_lattice_pile(const LatticePileSetup& s) {
  check_lattice(s.lattice);
  Outlook out;
  for (const int row : lattice_rows(s.lattice)) out.grains += row;
  out.bytes = out.grains * kBytesOfDisk;
  out.bytes_key = "lattice.base_grains";
  GrainExtremes extremes;
  extremes.least_mass = s.material.density * disk_grain(s.lattice.radius).area;
  out.take_step(engine_settings(s.material, s.motion, extremes, 1));
  check_background_damping(s.rest, out.time_step);
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
