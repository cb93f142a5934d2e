// Layers of spheres and superellipsoids.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/studies/point_load/layer.h"
#include "dem/grains/layer_3d.h"
#include "dem/grains/superellipsoid_family.h"
#include "dem/run/common.h"
#include "dem/run/softness.h"

namespace grainfield::dem {
namespace {

// Spheres have settled when the mean kinetic energy of one is below this share of m g r: then
// nothing rises by more than a hundredth of a radius any more.
constexpr double kSpheresSettled = 0.01;

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

ShapeKind shape_of(const PackingSetup& p) {
  return is_angular(p) ? ShapeKind::superellipsoid : ShapeKind::sphere;
}

}  // namespace

double force_of_load(const PointLoadSetup& s) {
  if (s.packing.dim == 2 || s.load.weights == 0) return s.load.force;
  return s.load.weights * s.material.density * mean_sphere_volume(s.packing) * s.material.gravity;
}

void Layer<3>::check(const Setup& s) {
  const PackingSetup& p = s.packing;
  check_packing(p);
  check_spheres(p);
  if (s.load.control == "speed") {
    throw std::invalid_argument(
        "load.control: found \"speed\" with packing.dim = 3, allowed: \"force\" (the piston "
        "presses grains in the plane)");
  }
  const bool angular = is_angular(p);
  if (s.load.probe_strain > 0 && p.sides != "periodic") {
    throw std::invalid_argument(
        fmt::format("load.probe_strain: found {:g} with packing.sides = \"{}\", allowed: 0 (layers "
                    "between periodic sides are strained)",
                    s.load.probe_strain, p.sides));
  }
  if (angular) check_superellipsoid_material(s.material);
  const ShapeKind shape = shape_of(p);
  check_method("load.rest", s.load.rest, s.material, s.motion, shape);
  check_method("load.method", s.load.method, s.material, s.motion, shape);
  if (s.load.probe_strain > 0) {
    check_quasistatic(fmt::format("load.probe_strain: found {:g}", s.load.probe_strain), "0",
                      s.material, s.motion, shape);
  }
  const double depth = falls(s) ? p.depth : 2 * p.rows * p.radius;
  const double fall = falls(s) ? std::max(0.0, loose_height(p) - depth) : 0;
  check_stiff_enough(s.material,
                     {mean_sphere_radius(p), depth, std::sqrt(2 * s.material.gravity * fall)});
}

SpaceGrains Layer<3>::draw(const Setup& s, Random& random, Allowance& allowance) {
  SpaceGrains out;
  if (!is_angular(s.packing)) return out;
  out.floor = floor_3d(s.packing, s.material.density, random);
  out.free = draw_layer(s.packing, random, [&] { return allowance.grant_one(1); });
  return out;
}

EngineSettings Layer<3>::settings(const Setup& s, const SpaceGrains& grains, double reserve) {
  const PackingSetup& p = s.packing;
  const double least = smallest_radius(p);
  GrainExtremes extremes;
  extremes.least_radius = least;
  extremes.least_mass = s.material.density * 4 / 3 * std::numbers::pi * least * least * least;
  if (is_angular(p)) {
    std::vector<ShapedGrain> all = grains.free;
    for (const NewGrain& g : grains.floor) all.emplace_back().axes = g.axes;
    extremes = extremes_of_superellipsoids(all, s.material.density);
  }
  EngineSettings out =
      engine_settings(s.material, s.motion, extremes, 1, false, reserve, shape_of(p));
  out.gravity_y = 0;
  out.gravity_z = -s.material.gravity;
  out.cell = layer_cell(p);
  check_background_damping(s.rest, out.time_step);
  return out;
}

Outlook Layer<3>::outlook(const Setup& s, const EngineSettings& settings) {
  const PackingSetup& p = s.packing;
  Outlook out;
  out.take_step(settings);
  out.grains = std::ceil(layer_spheres(p));
  out.fixed = floor_spheres(p);
  out.bytes = (out.grains + out.fixed) * kBytesOfSphere;
  out.bytes_key = falls(s) ? "packing.width" : "packing.columns";
  Times times;
  if (falls(s)) {
    times.add("packing.depth", std::sqrt(2 * loose_height(p) / s.material.gravity));
  }
  if (s.load.method == "damped") times.add("load.ramp_time", s.load.ramp_time);
  times.put_into(out);
  return out;
}

std::vector<Wall> Layer<3>::walls(const Setup& s) { return walls_3d(s.packing, s.material); }
std::vector<double> Layer<3>::sides(const Setup& s) {
  const auto sides = layer_sides(s.packing);
  return {sides[0], sides[1]};
}
double Layer<3>::height(const Snapshot& snapshot, const Setup& s) {
  return surface_3d(snapshot, s.packing);
}
void Layer<3>::add_figures(const Setup& s, const Snapshot& loaded,
                           std::map<std::string, double>& f) {
  f["load.force_over_weight"] =
      force_of_load(s) / (s.material.density * mean_sphere_volume(s.packing) * s.material.gravity);
  f["load.grains"] = static_cast<double>(1 + loaded.also_loaded.size());
}

Layer<3>::Layer(const Setup& setup, std::uint64_t seed)
    : setup_(setup), random_(seed), grains_(draw_all<Layer<3>>(setup_, random_)) {}

void Layer<3>::begin(Engine& engine) {
  const PackingSetup& p = setup_.packing;
  const double density = setup_.material.density;
  const bool drawn = is_angular(p);
  for (const NewGrain& g : drawn ? grains_.floor : floor_3d(p, density, random_)) engine.add(g);
  for (const NewGrain& g :
       drawn ? place_layer(p, grains_.free, density, random_) : grains_3d(p, density, random_)) {
    engine.add(g);
  }
  grains_ = {};
}

double Layer<3>::fall_time() const {
  return std::sqrt(2 * loose_height(setup_.packing) / setup_.material.gravity);
}

Built Layer<3>::go_on(const Engine& engine, double in_phase) const {
  const double mass = setup_.material.density * mean_sphere_volume(setup_.packing);
  const bool settled =
      engine.motion().kinetic_energy <= kSpheresSettled * mass * setup_.material.gravity *
                                            mean_sphere_radius(setup_.packing) * engine.grains();
  return in_phase >= fall_time() && settled ? Built::yes : Built::no;
}

double Layer<3>::share(const Diagnostics&, double in_phase) const {
  return 0.5 * in_phase / fall_time();
}

}  // namespace grainfield::dem
