// Layers of disks and polygons.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/studies/point_load/layer.h"
#include "dem/run/common.h"

namespace grainfield::dem {
namespace {

// Volume fraction of a layer of dropped rows, about.
constexpr double kLayerFraction = 0.85;
// A dropped row counts as settled when the mean kinetic energy per grain is below this share of
// m g r of a mean grain: then nothing rises by more than a hundredth of a radius any more.
constexpr double kRowSettled = 0.01;
// ... but is given at least the time of its fall and at most this, s.
constexpr double kMaxSettleTime = 2.0;

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

// Least time between two rows, s; `radius`: of a mean grain.
double row_time(const PointLoadSetup& s, double radius) {
  return 1.5 * std::sqrt(2 * (s.packing.drop_height + 2 * radius) / s.material.gravity);
}

}  // namespace

void Layer<2>::check(const Setup& s) {
  check_packing(s.packing);
  check_method("load.rest", s.load.rest, s.material, s.motion);
  check_method("load.method", s.load.method, s.material, s.motion);
  if (s.load.control == "speed" && s.load.method == "newton") {
    throw std::invalid_argument(
        "load.control: found \"speed\" with load.method = newton, allowed: \"force\" (a piston "
        "moves in time); or set load.method = damped");
  }
  grains_of(s.packing);
}

GrainSupply Layer<2>::draw(const Setup& s, Random& random, Allowance& allowance) {
  const PackingSetup& p = s.packing;
  return {p, random, draws_pentagons(p) ? allowance.grant(std::floor(pentagons_drawn(p))) : 0.0};
}

EngineSettings Layer<2>::settings(const Setup& s, const GrainSupply& grains, double reserve) {
  EngineSettings out = engine_settings(s.material, s.motion, grains.extremes(s.material.density), 1,
                                       draws_pentagons(s.packing), reserve);
  out.shape = s.packing.shape != "disk" ? ShapeKind::polygon : ShapeKind::disk;
  check_background_damping(s.rest, out.time_step);
  return out;
}

Outlook Layer<2>::outlook(const Setup& s, const EngineSettings& settings) {
  const PackingSetup& p = s.packing;
  const double radius = mean_radius(p);
  Outlook out;
  out.take_step(settings);
  out.grains = grains_of(p);
  if (p.floor == "rough") out.fixed = std::floor(0.5 * layer_width(p) / radius);
  out.bytes = (out.grains + out.fixed) * (p.shape != "disk" ? kBytesOfPolygon : kBytesOfDisk);
  out.bytes_key = p.kind == "layered"  ? "packing.width"
                  : p.rows > p.columns ? "packing.rows"
                                       : "packing.columns";
  Times times;
  if (p.kind == "layered") {
    times.add(p.drop_height > p.depth ? "packing.drop_height" : "packing.depth",
              p.depth / (2 * radius) * row_time(s, radius));
  }
  if (s.load.method == "damped" && s.load.control == "force")
    times.add("load.ramp_time", s.load.ramp_time);
  times.put_into(out);
  return out;
}

std::vector<Wall> Layer<2>::walls(const Setup& s) { return layer_walls(s.packing, s.material); }
std::vector<double> Layer<2>::sides(const Setup& s) { return {layer_width(s.packing)}; }
double Layer<2>::height(const Snapshot& snapshot, const Setup& s) {
  return surface_height(snapshot, layer_width(s.packing));
}

Layer<2>::Layer(const Setup& setup, std::uint64_t seed)
    : setup_(setup), random_(seed), supply_(draw_all<Layer<2>>(setup_, random_)) {}

void Layer<2>::begin(Engine& engine) {
  const double density = setup_.material.density;
  for (const NewGrain& g : floor_grains(setup_.packing, supply_, density, random_)) engine.add(g);
  if (falls(setup_)) return drop_row(engine);
  for (const NewGrain& g : lattice_grains(setup_.packing, density, random_)) engine.add(g);
}

void Layer<2>::drop_row(Engine& engine) {
  const double top = rows_dropped_ == 0 ? 0.0 : engine.measure().height;
  for (const NewGrain& g : row_of_grains(setup_.packing, supply_, setup_.material.density,
                                         top + setup_.packing.drop_height, random_)) {
    engine.add(g);
  }
  ++rows_dropped_;
}

Built Layer<2>::go_on(Engine& engine, double in_phase) {
  const double r = 0.5 * (smallest_radius(setup_.packing) + largest_radius(setup_.packing));
  const double mass = setup_.material.density * std::numbers::pi * r * r;
  const bool settled = engine.measure().kinetic_energy <=
                       kRowSettled * mass * setup_.material.gravity * r * engine.grains();
  if (in_phase < row_time(setup_, r) || (!settled && in_phase < kMaxSettleTime)) return Built::no;
  if (height(engine.snapshot(), setup_) >= setup_.packing.depth) return Built::yes;
  drop_row(engine);
  return Built::in_part;
}

double Layer<2>::share(const Diagnostics& state, double) const {
  return (state.height - setup_.packing.drop_height) / setup_.packing.depth;
}

std::string Layer<2>::phase() const { return fmt::format("deposit row {}", rows_dropped_); }

void Layer<2>::visit(Archive& archive) {
  archive(rows_dropped_);
  archive(random_);
  long taken = supply_.taken();
  archive(taken);
  supply_.set_taken(taken);
}

}  // namespace grainfield::dem
