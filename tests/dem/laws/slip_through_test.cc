// A grain that is pressed between two others slips through below a critical friction (Wellmann,
// figure 13).
#include <gtest/gtest.h>

#include <cmath>

#include "dem/engine/engine.h"

namespace grainfield::dem {
namespace {

constexpr double kRadius = 0.01, kStiffness = 1e4, kGravity = 10;

// The largest load that the pair below bears: the lines of centres are inclined by alpha at first
// touch and by a < alpha with the overlap 2 r - 2 r cos(alpha)/cos(a), and both contacts slide:
// F = 2 k overlap (sin a + mu cos a).
double most_load(double alpha, double mu) {
  double most = 0;
  for (int i = 0; i <= 100000; ++i) {
    const double a = alpha * i / 100000;
    const double overlap = 2 * kRadius * (1 - std::cos(alpha) / std::cos(a));
    most = std::max(most, 2 * kStiffness * overlap * (std::sin(a) + mu * std::cos(a)));
  }
  return most;
}

double critical_friction(double alpha, double load) {
  double low = 0, high = 10;
  for (int i = 0; i < 60; ++i) {
    const double mu = 0.5 * (low + high);
    (most_load(alpha, mu) < load ? low : high) = mu;
  }
  return high;
}

// So much drag that the grain sinks without overshooting; its weight is the load.
bool slips_through(ShapeKind shape, double alpha, double load, double mu) {
  const double mass = load / kGravity, frequency = std::sqrt(2 * kStiffness / mass);
  EngineSettings s;
  s.shape = shape;
  s.law = LinearLaw{kStiffness, kStiffness, 0, 0};
  s.friction = mu;
  s.gravity_y = 0;
  (shape == ShapeKind::sphere ? s.gravity_z : s.gravity_y) = -kGravity;
  s.time_step = 0.05 / frequency;
  const auto engine = make_engine(s);
  engine->set_background_damping(2 * frequency);
  for (const double side : {-1, 0, 1}) {
    NewGrain g;
    g.radius = kRadius;
    g.mass = mass;
    g.density = 1;
    g.fixed = side != 0;
    g.x = side * 2 * kRadius * std::cos(alpha);
    if (side == 0) (shape == ShapeKind::sphere ? g.z : g.y) = 2 * kRadius * std::sin(alpha);
    engine->add(g);
  }
  for (int i = 0; i < 800; ++i) {
    engine->step(250);
    const Grain upper = engine->snapshot().grains[1];
    if ((shape == ShapeKind::sphere ? upper.position.z() : upper.position.y()) < 0) return true;
  }
  return false;
}

// The engine's critical friction by bisection, to 1e-4.
double found_friction(ShapeKind shape, double alpha, double load) {
  double low = 0, high = 2;
  while (high - low > 1e-4) {
    const double mu = 0.5 * (low + high);
    (slips_through(shape, alpha, load, mu) ? low : high) = mu;
  }
  return 0.5 * (low + high);
}

TEST(SlipThrough, HappensBelowItsCriticalFriction) {
  for (const ShapeKind shape : {ShapeKind::disk, ShapeKind::sphere}) {
    for (const double degrees : {20.0, 30.0, 40.0}) {
      const double alpha = degrees * M_PI / 180;
      double last = 0;
      for (const double more : {1.2, 2.0}) {  // times what it bears without friction
        const double load = more * most_load(alpha, 0);
        const double expected = critical_friction(alpha, load);
        EXPECT_NEAR(found_friction(shape, alpha, load), expected, 2e-3 * expected + 1e-4)
            << degrees << " deg, " << more;
        EXPECT_GT(expected, last) << "a larger load needs more friction";
        last = expected;
      }
      EXPECT_FALSE(slips_through(shape, alpha, 0.9 * most_load(alpha, 0), 0));
    }
  }
}

}  // namespace
}  // namespace grainfield::dem
