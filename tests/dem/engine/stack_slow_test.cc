// Grains at rest stay where they are, for a million steps.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/shapes/polygon.h"

namespace grainfield::dem {
namespace {

constexpr long kSteps = 1000000;
// Positions are of the order of 0.1 m: a drift of 1e-10 m would be 1e7 units of their rounding, and
// 1e-8 of a radius. Nothing but rounding may move a grain.
constexpr double kDrift = 1e-10;
const Outline kSquare{{-0.01, -0.01}, {0.01, -0.01}, {0.01, 0.01}, {-0.01, 0.01}};

struct Scene {
  bool area = false;
  IntegratorKind integrator = IntegratorKind::verlet;
};

// With squares of side 0.02 m in place of disks of radius 0.01 m where `polygons`.
std::unique_ptr<Engine> engine_for(const Scene& scene, bool polygons = false) {
  EngineSettings s;
  if (scene.area) {
    s.law = OverlapAreaLaw{1e7, 0.75};
  } else {
    s.law = LinearLaw{1e7, 2e7 / 7, 500, 250};
  }
  s.integrator = scene.integrator;
  s.friction = 0.5;
  s.shape = polygons ? ShapeKind::polygon : ShapeKind::disk;
  const GrainExtremes extremes =
      polygons
          ? GrainExtremes{5000 * area_of(kSquare), edge_steepness(kSquare), 5000 * area_of(kSquare)}
          : GrainExtremes{5000 * std::numbers::pi * 1e-4, 0, 0};
  s.time_step = 0.8 * stable_time_step(s, extremes);
  auto engine = make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
  return engine;
}

NewGrain disk(double x, double y) {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.radius = 0.01;
  g.density = 5000;
  return g;
}

NewGrain square(double x, double y) {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.density = 5000;
  g.outline = kSquare;
  return g;
}

// Comes to rest with background damping, then runs on without it.
double drift_of(Engine& engine) {
  engine.set_background_damping(100);
  for (int k = 0; k < 400; ++k) {
    engine.step(500);
    const Diagnostics d = engine.measure();
    if (d.unbalanced_force_ratio < 1e-12) break;
  }
  EXPECT_LT(engine.measure().unbalanced_force_ratio, 1e-9);
  engine.set_background_damping(0);
  const Snapshot before = engine.snapshot();
  engine.step(kSteps);
  const Snapshot after = engine.snapshot();
  EXPECT_EQ(before.contacts.size(), after.contacts.size());
  double most = 0;
  for (std::size_t i = 0; i < before.grains.size(); ++i) {
    const Grain &a = before.grains[i], &b = after.grains[i];
    most = std::max(most, (b.position - a.position).norm());
    most = std::max(most, a.radius * std::fabs(b.angle - a.angle));
  }
  return most;
}

std::string name_of(const testing::TestParamInfo<Scene>& scene) {
  return std::string(scene.param.area ? "OverlapArea" : "Linear") +
         (scene.param.integrator == IntegratorKind::verlet ? "Verlet" : "Gear");
}

class StackAtRest : public testing::TestWithParam<Scene> {};

// Three disks: the upper one wedges the lower ones apart, held by friction alone.
TEST_P(StackAtRest, PyramidOfDisksDoesNotDrift) {
  const auto engine = engine_for(GetParam());
  engine->add(disk(-0.01, 0.01));
  engine->add(disk(0.01, 0.01));
  engine->add(disk(0, 0.01 + 0.01 * std::sqrt(3.0)));
  EXPECT_LT(drift_of(*engine), kDrift);
}

// Rows of five and four disks in turn between walls.
TEST_P(StackAtRest, LatticeBetweenWallsDoesNotDrift) {
  const auto engine = engine_for(GetParam());
  engine->add_wall({"left", {-0.05, 0, 0}, {1, 0, 0}, 0.2});
  engine->add_wall({"right", {0.05, 0, 0}, {-1, 0, 0}, 0.2});
  for (int row = 0; row < 4; ++row) {
    for (int k = 0; k < 5 - row % 2; ++k) {
      engine->add(disk(0.02 * (k - 0.5 * (4 - row % 2)), 0.01 + 0.01 * std::sqrt(3.0) * row));
    }
  }
  EXPECT_LT(drift_of(*engine), kDrift);
}

// Disks exactly above one another: nothing pushes them sideways, so the column stands.
TEST_P(StackAtRest, ColumnOfDisksDoesNotDrift) {
  const auto engine = engine_for(GetParam());
  for (int k = 0; k < 5; ++k) engine->add(disk(0, 0.01 + 0.02 * k));
  EXPECT_LT(drift_of(*engine), kDrift);
  for (const Grain& g : engine->snapshot().grains) EXPECT_EQ(g.position.x(), 0);
}

TEST_P(StackAtRest, ColumnOfSquaresDoesNotDrift) {
  const auto engine = engine_for(GetParam(), true);
  for (int k = 0; k < 5; ++k) engine->add(square(0, 0.01 + 0.02 * k));
  EXPECT_LT(drift_of(*engine), kDrift);
}

// Rows of four to one squares, each on two below it, with gaps in the rows. The linear law is left
// out: its force k * depth does not know the width of an edge, and squares on two supports rock.
TEST_P(StackAtRest, BrickworkOfSquaresDoesNotDrift) {
  if (!GetParam().area) GTEST_SKIP() << "linear law";
  const auto engine = engine_for(GetParam(), true);
  for (int row = 0; row < 4; ++row) {
    for (int k = 0; k + row < 4; ++k) {
      engine->add(square(0.021 * (k - 0.5 * (3 - row)), 0.01 + 0.02 * row));
    }
  }
  EXPECT_LT(drift_of(*engine), kDrift);
}

INSTANTIATE_TEST_SUITE_P(LawsAndIntegrators, StackAtRest,
                         testing::Values(Scene{false, IntegratorKind::verlet},
                                         Scene{true, IntegratorKind::verlet},
                                         Scene{false, IntegratorKind::gear},
                                         Scene{true, IntegratorKind::gear}),
                         name_of);

}  // namespace
}  // namespace grainfield::dem
