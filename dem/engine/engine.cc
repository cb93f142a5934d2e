#include "dem/engine/engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/engine/engine_loop.h"
#include "dem/motion/gear.h"
#include "dem/motion/verlet.h"
#include "dem/shapes/disk_store.h"
#include "dem/shapes/polygon_store.h"

namespace grainfield::dem {
namespace {

template <class Shape, class Law>
std::unique_ptr<Engine> with_shape(const EngineSettings& settings, const Law& law) {
  if (settings.integrator == IntegratorKind::gear) {
    return std::make_unique<EngineLoop<Shape, Law, GearIntegrator<2>>>(settings, law);
  }
  return std::make_unique<EngineLoop<Shape, Law, VerletIntegrator<2>>>(settings, law);
}

}  // namespace

double stable_time_step(const EngineSettings& settings, double least_mass) {
  const double viscous_limit = settings.integrator == IntegratorKind::gear ? 0.16 : 1.0;
  return std::visit(
      [&](const auto& law) {
        const double elastic = 0.1 * std::numbers::pi * std::sqrt(least_mass / law.stiffness());
        const double rate = law.viscous_rate(least_mass);
        return rate > 0 ? std::min(elastic, viscous_limit / rate) : elastic;
      },
      settings.law);
}

double stable_time_step(const EngineSettings& settings, const GrainExtremes& extremes) {
  double limit = stable_time_step(settings, extremes.least_mass);
  if (extremes.steepest_edge > 0) {
    const double share = settings.integrator == IntegratorKind::gear ? 0.16 : 1.4;
    std::visit(
        [&](const auto& law) {
          // Positive root of c dt + k dt^2/2 = share.
          const double k = law.edge_stiffness(extremes.steepest_edge) / extremes.steep_mass;
          const double c = law.edge_rate(extremes.steep_mass, extremes.steepest_edge);
          limit = std::min(limit, 2 * share / (c + std::sqrt(c * c + 2 * k * share)));
        },
        settings.law);
  }
  return limit;
}

std::unique_ptr<Engine> make_engine(const EngineSettings& settings) {
  if (!(settings.time_step > 0)) {
    throw std::invalid_argument(
        fmt::format("motion.time_step: found {} s, allowed: above 0", settings.time_step));
  }
  if (!(settings.friction >= 0)) {
    throw std::invalid_argument(
        fmt::format("material.friction: found {}, allowed: 0 or more", settings.friction));
  }
  // Shapes times laws times integrators, each compiled as one loop. A new law joins the variant in
  // engine.h.
  return std::visit(
      [&settings](const auto& law) {
        return settings.polygons ? with_shape<PolygonStore>(settings, law)
                                 : with_shape<DiskStore>(settings, law);
      },
      settings.law);
}

std::unique_ptr<Engine> make_engine(const EngineSettings& settings, const Snapshot& start) {
  if (start.dim != 2) throw std::invalid_argument("the snapshot is 3D; a 2D one is needed");
  EngineSettings same = settings;
  same.gravity_x = start.gravity.x();
  same.gravity_y = start.gravity.y();
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
    if (engine->add(grain) != g.id) {
      throw std::invalid_argument("the snapshot's grains are not numbered 0, 1, 2, ...");
    }
  }
  engine->remember(start.contacts);
  return engine;
}

}  // namespace grainfield::dem
