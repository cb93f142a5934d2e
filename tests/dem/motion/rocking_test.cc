// How slowly Roul's law ends the rocking of a polygon on its edges: what keeps a pile from coming
// to rest by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/engine/engine.h"

namespace grainfield::dem {
namespace {

/// Highest rise of a heptagon's centre above its place on an edge, in radii, during 0.05 s from
/// `from` (s) on, after it was let go from a tilt of 0.1 rad.
double rise(double from, double damping, double time_step) {
  constexpr int kCorners = 7;
  constexpr double kRadius = 0.00275, kTilt = 0.1;
  EngineSettings settings;
  settings.law = OverlapAreaLaw{1e7, damping};
  settings.friction = 0.54;
  settings.shape = ShapeKind::polygon;
  settings.time_step = time_step;
  const auto engine = make_engine(settings);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.54});
  NewGrain g;
  g.density = 5000;
  g.angle = kTilt;
  double lowest = 0;
  for (int k = 0; k < kCorners; ++k) {
    const double a = std::numbers::pi * ((2.0 * k + 1) / kCorners - 0.5);
    g.outline.push_back({kRadius * std::cos(a), kRadius * std::sin(a)});
    lowest = std::min(lowest, kRadius * std::sin(a + kTilt));
  }
  g.y = -lowest;
  engine->add(g);
  engine->step(std::lround(from / time_step));
  double highest = 0;
  for (int k = 0; k < 100; ++k) {
    engine->step(std::lround(5e-4 / time_step));
    highest = std::max(highest, engine->snapshot().grains[0].position.y());
  }
  return highest / kRadius - std::cos(std::numbers::pi / kCorners);
}

TEST(Rocking, GoesOnForASecondWhateverTheTimeStep) {
  const double start = rise(0, 0.75, 1e-5);
  const double late = rise(0.95, 0.75, 1e-5);
  EXPECT_GT(start, 0.035);
  EXPECT_NEAR(late / start, 0.5, 0.1);
  EXPECT_NEAR(rise(0.95, 0.75, 5e-6), late, 0.1 * late);
  // Twice the damping only ends it in about half the time.
  EXPECT_NEAR(rise(0.95, 1.5, 1e-5) / start, 0.26, 0.1);
}

}  // namespace
}  // namespace grainfield::dem
