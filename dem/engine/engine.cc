#include "dem/engine/engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/engine/engine_of.h"

namespace grainfield::dem {
namespace {

/// visit(law) for every law of the settings.
template <class Visit>
void visit_laws(const EngineSettings& settings, Visit visit) {
  if (settings.material_pairs.empty()) std::visit(visit, settings.law);
  for (const MaterialPair& pair : settings.material_pairs) std::visit(visit, pair.law);
}

}  // namespace

double stable_time_step(const EngineSettings& settings, double least_mass, double least_radius) {
  const double viscous_limit =
      settings.integrator.visit([](auto kind) { return kind.viscous_limit; });
  double limit = std::numeric_limits<double>::infinity();
  visit_laws(settings, [&](const auto& law) {
    limit = std::min(limit,
                     0.1 * std::numbers::pi * std::sqrt(least_mass / law.stiffness(least_radius)));
    const double rate = law.viscous_rate(least_mass, least_radius);
    if (rate > 0) limit = std::min(limit, viscous_limit / rate);
  });
  return limit;
}

double stable_time_step(const EngineSettings& settings, const GrainExtremes& extremes) {
  double limit = stable_time_step(settings, extremes.least_mass, extremes.least_radius);
  if (!(extremes.steepest_edge > 0)) return limit;
  const double share = settings.integrator.visit([](auto kind) { return kind.edge_limit; });
  visit_laws(settings, [&](const auto& law) {
    // Positive root of c dt + k dt^2/2 = share.
    const double k = law.edge_stiffness(extremes.steepest_edge) / extremes.steep_mass;
    const double c = law.edge_rate(extremes.steep_mass, extremes.steepest_edge);
    limit = std::min(limit, 2 * share / (c + std::sqrt(c * c + 2 * k * share)));
  });
  return limit;
}

std::unique_ptr<Engine> make_engine(const EngineSettings& settings) {
  if (!(settings.time_step > 0)) {
    throw std::invalid_argument(
        fmt::format("motion.time_step: found {} s, allowed: above 0", settings.time_step));
  }
  check_materials(settings);
  return settings.shape.visit(
      [&](auto kind) { return engine_of<typename decltype(kind)::Store>(settings); });
}

std::unique_ptr<Engine> make_engine(const EngineSettings& settings, const Snapshot& start) {
  const int dim = settings.shape.visit([](auto kind) { return kind.dim; });
  if (start.dim != dim) {
    throw std::invalid_argument(
        fmt::format("the snapshot is {}D; a {}D one is needed", start.dim, dim));
  }
  EngineSettings same = settings;
  same.gravity_x = start.gravity.x();
  same.gravity_y = start.gravity.y();
  same.gravity_z = start.gravity.z();
  std::unique_ptr<Engine> engine = make_engine(same);
  for (const Wall& wall : start.walls) engine->add_wall(wall);
  for (const Grain& g : start.grains) {
    NewGrain grain;
    grain.x = g.position.x();
    grain.y = g.position.y();
    grain.vx = g.velocity.x();
    grain.vy = g.velocity.y();
    grain.angle = g.angle;
    grain.spin = g.spin;
    grain.radius = g.radius;
    grain.density = g.mass / g.volume;
    grain.fixed = g.fixed;
    grain.outline = g.outline;
    grain.z = g.position.z();
    grain.vz = g.velocity.z();
    grain.spin_x = g.angular_velocity.x();
    grain.spin_y = g.angular_velocity.y();
    grain.orientation = g.orientation;
    if (engine->add(grain) != g.id) {
      throw std::invalid_argument("the snapshot's grains are not numbered 0, 1, 2, ...");
    }
  }
  engine->remember(start.contacts);
  return engine;
}

}  // namespace grainfield::dem
