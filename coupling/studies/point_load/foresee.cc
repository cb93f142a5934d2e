// What a layer under a point load will take, and whether it can be set up.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "coupling/studies/point_load/simulation.h"
#include "coupling/studies/point_load/simulation_space.h"
#include "dem/grains/grain_family.h"
#include "dem/grains/layer_3d.h"
#include "dem/grains/packing.h"
#include "dem/run/common.h"
#include "dem/run/judge_draws.h"

namespace grainfield::dem {
namespace {

// Volume fraction of a layer of dropped rows, about.
constexpr double kLayerFraction = 0.85;

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
      for (const NewGrain& g : floor_3d(p, s.material.density, random)) {
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

}  // namespace grainfield::dem
