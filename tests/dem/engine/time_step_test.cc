// Steps beyond the limit that holds for chains of equal polygons: irregular grains keep their
// restitution and packings of them come to rest (engine.h: kMostOfLimit).
#include <gtest/gtest.h>

#include <cmath>

#include "dem/engine/engine.h"
#include "dem/grains/grain_family.h"
#include "dem/random/random.h"

namespace grainfield::dem {
namespace {

// Roul's table 2.
struct Population {
  std::vector<ShapedGrain> grains;
  EngineSettings settings;
  double limit = 0;

  explicit Population(int count) {
    ShapeSetup shape;
    shape.kind = "rand1";
    shape.radius = 0.00275;
    shape.polydispersity = 0.3;
    shape.corners_min = 6;
    shape.corners_max = 8;
    Random random(3);
    for (int k = 0; k < count; ++k) grains.push_back(draw_grain(shape, random));
    settings.law = OverlapAreaLaw{1e7, 0.75};
    settings.friction = 0.54;
    settings.shape = ShapeKind::polygon;
    limit = stable_time_step(settings, extremes_of(grains, 5000));
  }
};

// Share of the kinetic energy that a pair keeps which meets at the relative speed v, free of
// gravity.
double energy_kept(Population& p, int pair, double v, double share) {
  p.settings.gravity_y = 0;
  p.settings.time_step = share * p.limit;
  const auto engine = make_engine(p.settings);
  const ShapedGrain &one = p.grains[2 * pair], &two = p.grains[2 * pair + 1];
  const double gap = 1e-4, reach = one.radius + two.radius;
  NewGrain a = one.at(0, 0, 5000);
  NewGrain b = two.at(0.0015 * std::sin(pair), gap + reach, 5000);
  a.vy = 0.5 * v;
  b.vy = -0.5 * v;
  engine->add(a);
  engine->add(b);
  const double before = engine->measure().kinetic_energy;
  engine->step(std::lround(((gap + reach) / v + 1e-3) / p.settings.time_step));
  return engine->measure().kinetic_energy / before;
}

TEST(TimeStep, ImpactsAtTwoAndAHalfTimesTheLimitKeepTheirRestitution) {
  Population p(400);
  for (const double v : {3.0, 0.3}) {
    double exact = 0, coarse = 0, off = 0;
    for (int pair = 0; pair < 200; ++pair) {
      const double fine = energy_kept(p, pair, v, 0.1), at = energy_kept(p, pair, v, kMostOfLimit);
      exact += fine / 200;
      coarse += at / 200;
      off += std::fabs(at - fine) / 200;
    }
    EXPECT_GT(exact, 0.1);
    EXPECT_LT(exact, 0.7);
    EXPECT_NEAR(coarse, exact, 0.005) << v;
    EXPECT_LT(off, 0.01) << v;
  }
}

// 144 grains dropped into a box: the unbalanced force ratio in the end.
double unbalanced_at(double share) {
  Population p(144);
  p.settings.time_step = share * p.limit;
  const auto engine = make_engine(p.settings);
  const double cell = 0.0075;
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.54});
  engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.54});
  engine->add_wall({"right", {12 * cell, 0, 0}, {-1, 0, 0}, 0.54});
  for (int k = 0; k < 144; ++k) {
    engine->add(p.grains[k].at((k % 12 + 0.5) * cell, (k / 12 + 0.5) * cell, 5000));
  }
  engine->step(std::lround(0.3 / p.settings.time_step));
  engine->set_background_damping(100);
  engine->step(std::lround(0.7 / p.settings.time_step));
  return engine->measure().unbalanced_force_ratio;
}

TEST(TimeStep, PackingsOfIrregularPolygonsRestAtTwoAndAHalfTimesTheLimitAndNotFarBeyond) {
  EXPECT_LT(unbalanced_at(1), 1e-6);
  EXPECT_LT(unbalanced_at(kMostOfLimit), 1e-6);
  double wild = 1;
  try {
    wild = unbalanced_at(3 * kMostOfLimit);
  } catch (const ComputationFailed&) {
  }
  EXPECT_GT(wild, 1e-4);
}

}  // namespace
}  // namespace grainfield::dem
