#include "dem/engine/engine.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/engine/engine_of.h"
#include "dem/motion/leaping.h"
#include "dem/snapshot/added_forces_mark.h"
#include "dem/snapshot/images.h"
#include "dem/space/moving_cell.h"

namespace grainfield::dem {
namespace {

/// visit(law, rolling) for every law of the settings.
template <class Visit>
void visit_laws(const EngineSettings& settings, Visit visit) {
  const auto call = [&](const AnyLaw& any, const RollingLaw& rolling) {
    std::visit([&](const auto& law) { visit(law, rolling); }, any);
  };
  if (settings.material_pairs.empty()) call(settings.law, settings.rolling);
  for (const MaterialPair& pair : settings.material_pairs) call(pair.law, pair.rolling);
}

/// Springs that are unknown are the tangential force, as at rest.
std::vector<Contact> with_springs(std::vector<Contact> contacts) {
  for (Contact& c : contacts) {
    if (std::isnan(c.spring)) c.spring = c.tangential_force;
    if (!c.spring_vector.allFinite()) c.spring_vector = c.force + c.normal_force * c.normal;
  }
  return contacts;
}

}  // namespace

void check_rolling(const EngineSettings& settings) {
  if (settings.resist_rolling()) {
    const bool plane = settings.shape.visit([](auto kind) { return kind.dim; }) == 2;
    visit_laws(settings, [&](const auto&, const RollingLaw& rolling) {
      if (!plane || !rolling.twists()) return;
      throw std::invalid_argument(
          fmt::format("material.twisting_friction: found {}, allowed in the plane: 0",
                      rolling.twisting_friction));
    });
  }
  const double alpha = settings.local_damping;
  if (!(alpha >= 0 && alpha < 1)) {
    throw std::invalid_argument(
        fmt::format("motion.local_damping: found {}, allowed: 0 or more, below 1", alpha));
  }
  if (alpha > 0 && !leaps(settings.integrator)) {
    throw std::invalid_argument(fmt::format(
        "motion.local_damping: found {} with motion.integrator \"{}\", allowed: {} (a force that "
        "leaps with the velocity's sign has no derivatives to predict)",
        alpha, settings.integrator.name(), fmt::join(integrators_that_leap(), " | ")));
  }
}

void refuse_rolling_polygons() {
  throw std::invalid_argument(
      "material.rolling_friction: found above 0, allowed for polygons: 0 (their corners resist "
      "rolling)");
}

void refuse_rolling_superellipsoids() {
  throw std::invalid_argument(
      "material.rolling_friction: found above 0, allowed for superellipsoids: 0 (their shapes "
      "resist rolling)");
}

namespace {

struct StepLimit {
  double step = std::numeric_limits<double>::infinity();
  StepBound bound = StepBound::spring;

  void lower(double other, StepBound why) {
    if (other < step) *this = {other, why};
  }
};

StepLimit limit_of_grains(const EngineSettings& settings, double least_mass, double least_radius) {
  const double viscous_limit =
      settings.integrator.visit([](auto kind) { return kind.viscous_limit; });
  StepLimit limit;
  visit_laws(settings, [&](const auto& law, const RollingLaw& rolling) {
    if (rolling.twists() && !(least_radius > 0)) {
      throw std::invalid_argument(
          "stable_time_step: found no least radius, needed: above 0, as grains resist twisting");
    }
    const double spring = law.stiffness(least_radius);
    const double resistance = rolling.step_stiffness(least_radius);
    limit.lower(0.1 * std::numbers::pi * std::sqrt(least_mass / std::max(spring, resistance)),
                resistance > spring ? StepBound::rolling : StepBound::spring);
    const double rate =
        law.viscous_rate(least_mass, least_radius) + rolling.step_rate(least_mass, least_radius);
    if (rate > 0) limit.lower(viscous_limit / rate, StepBound::dashpots);
  });
  return limit;
}

StepLimit limit_of(const EngineSettings& settings, const GrainExtremes& extremes) {
  StepLimit limit = limit_of_grains(settings, extremes.least_mass, extremes.least_radius);
  if (!(extremes.steepest_edge > 0)) return limit;
  const double share = settings.integrator.visit([](auto kind) { return kind.edge_limit; });
  visit_laws(settings, [&](const auto& law, const RollingLaw&) {
    const bool by_width = law.edges == EdgeMeasure::width;
    const double edge = by_width ? extremes.widest_edge : extremes.steepest_edge;
    const double mass = by_width ? extremes.wide_mass : extremes.steep_mass;
    // Positive root of c dt + k dt^2/2 = share.
    const double k = law.edge_stiffness(edge) / mass;
    const double c = law.edge_rate(mass, edge);
    limit.lower(2 * share / (c + std::sqrt(c * c + 2 * k * share)), StepBound::edges);
  });
  return limit;
}

}  // namespace

double stable_time_step(const EngineSettings& settings, double least_mass, double least_radius) {
  return limit_of_grains(settings, least_mass, least_radius).step;
}

double stable_time_step(const EngineSettings& settings, const GrainExtremes& extremes) {
  return limit_of(settings, extremes).step;
}

StepBound step_bound(const EngineSettings& settings, const GrainExtremes& extremes) {
  return limit_of(settings, extremes).bound;
}

void Engine::set_wall_motion(const std::string& name, const WallMotion& motion) {
  std::vector<std::string> names;
  for (const Wall& wall : walls()) {
    if (wall.name == name) return set_wall_motion(static_cast<int>(names.size()), motion);
    names.push_back(wall.name);
  }
  throw std::invalid_argument(
      fmt::format("found wall \"{}\", allowed: {}", name, fmt::join(names, ", ")));
}

std::unique_ptr<Engine> make_engine(const EngineSettings& settings) {
  if (!(settings.time_step > 0)) {
    throw std::invalid_argument(
        fmt::format("motion.time_step: found {} s, allowed: above 0", settings.time_step));
  }
  check_materials(settings);
  check_cell(settings.cell, settings.shape.visit([](auto kind) { return kind.dim; }),
             settings.time_step);
  check_integrator(settings);
  check_rolling(settings);
  if (settings.energy_balance && !leaps(settings.integrator)) {
    throw std::invalid_argument(
        fmt::format("energy_balance: found motion.integrator \"{}\", allowed: {}",
                    settings.integrator.name(), fmt::join(integrators_that_leap(), " | ")));
  }
  return settings.shape.visit(
      [&](auto kind) { return engine_of<typename decltype(kind)::Store>(settings); });
}

std::unique_ptr<Engine> make_engine(const EngineSettings& settings, const Snapshot& start) {
  const int dim = settings.shape.visit([](auto kind) { return kind.dim; });
  if (start.dim != dim) {
    throw std::invalid_argument(
        fmt::format("the snapshot is {}D; a {}D one is needed", start.dim, dim));
  }
  refuse_added_forces(start, "the snapshot");
  EngineSettings same = settings;
  same.gravity_x = start.gravity.x();
  same.gravity_y = start.gravity.y();
  same.gravity_z = start.gravity.z();
  same.cell = start.cell;
  std::unique_ptr<Engine> engine = make_engine(same);
  for (const Wall& wall : start.walls) engine->add_wall(wall, wall.material);
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
    grain.mass = g.mass;
    grain.moments = {g.moments.x(), g.moments.y(), dim == 2 ? g.inertia : g.moments.z()};
    grain.fixed = g.fixed;
    grain.rotates = g.rotates;
    grain.material = g.material;
    grain.outline = g.outline;
    grain.axes = {g.axes.x(), g.axes.y(), g.axes.z()};
    grain.exponents = {g.exponents[0], g.exponents[1]};
    grain.z = g.position.z();
    grain.vz = g.velocity.z();
    grain.spin_x = g.angular_velocity.x();
    grain.spin_y = g.angular_velocity.y();
    grain.orientation = g.orientation;
    grain.image = image_in(engine->cell(), start.cell, g.image);
    if (engine->add(grain) != g.id) {
      throw std::invalid_argument("the snapshot's grains are not numbered 0, 1, 2, ...");
    }
  }
  engine->remember(with_springs(start.contacts));
  if (start.loaded_grain >= 0) {
    AppliedForce force;
    force.id = start.loaded_grain;
    force.fx = start.applied_force.x();
    force.fy = start.applied_force.y();
    force.fz = start.applied_force.z();
    engine->apply(force, start.also_loaded);
  }
  return engine;
}

}  // namespace grainfield::dem
