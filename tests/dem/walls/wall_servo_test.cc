// A servo's lid on a single grain.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/dem/wall_scene.h"

namespace grainfield::dem {
namespace {

constexpr double kTarget = 500;  // N

WallMotion lid_of(double max_speed) {
  WallMotion lid;
  lid.servo.emplace();
  lid.servo->force = kTarget;
  lid.servo->max_speed = max_speed;
  return lid;
}
/// A grain on a floor under a lid, pressed by `push`, N.
std::unique_ptr<Engine> pressed(double push) {
  const double stiffness = 1e6;
  auto engine = make_engine(disks(LinearLaw{stiffness, 0, 300, 0}, 1e-5));
  const double depth = push / stiffness;
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0});
  engine->add_wall({"lid", {0, 2 * kRadius - 2 * depth, 0}, {0, -1, 0}, 0});
  engine->add(grain({0, kRadius - depth, 0}, {0, 0, 0}));
  return engine;
}
double push_of(const Engine& engine) { return engine.walls()[1].force.y(); }

// At its largest speed for long, it has not saved up speed for afterwards.
TEST(Servo, DoesNotOvershootAfterALongWay) {
  const auto engine = pressed(1);
  engine->set_wall_motion("lid", lid_of(0.05));
  double most = 0, first = 0;
  for (int k = 0; k < 10000; ++k) {
    engine->step(1);
    const double push = push_of(*engine);
    if (k == 1000) first = push;
    most = std::max(most, push);
  }
  EXPECT_NEAR(first, 0.5 * 1e6 * 0.05 * 1000 * 1e-5, 0.1 * kTarget);  // still on its way
  EXPECT_NEAR(push_of(*engine), kTarget, 1e-3 * kTarget);
  EXPECT_LT(most, 1.1 * kTarget);
}

// On a grain that is pressed by its target already, it begins at rest.
TEST(Servo, TakesOverAGrainWithoutAJolt) {
  const auto engine = pressed(kTarget);
  engine->step(10);
  EXPECT_NEAR(push_of(*engine), kTarget, 1e-9 * kTarget);
  engine->set_wall_motion("lid", lid_of(1));
  for (int k = 0; k < 100; ++k) {
    engine->step(1);
    EXPECT_NEAR(push_of(*engine), kTarget, 1e-6 * kTarget) << k;
  }
}

}  // namespace
}  // namespace grainfield::dem
