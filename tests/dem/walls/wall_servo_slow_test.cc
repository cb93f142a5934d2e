// Servo-controlled walls, and scenes with round walls that move.
#include <gmock/gmock.h>

#include <cmath>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "dem/walls/box.h"

namespace grainfield::dem {
namespace {

// 528 disks between four planes, pressed by a lid, then from the side.
struct Press {
  std::unique_ptr<Engine> engine;
  double stress = 2000;

  Press(const AnyLaw& law, double damping) {
    EngineSettings s;
    s.law = law;
    s.time_step = 4e-5;
    s.gravity_y = 0;
    s.friction = 0.3;
    engine = make_engine(s);
    for (const Wall& w : box_walls({0, 0, 0}, {0.264, 0.25, 0}, 0.1, 2)) engine->add_wall(w);
    Random random(9);
    for (int row = 0; row < 22; ++row) {
      for (int column = 0; column < 24; ++column) {
        NewGrain g;
        g.radius = random.uniform(0.0042, 0.0052);
        g.x = 0.0055 + 0.011 * column;
        g.y = 0.0055 + 0.011 * row;
        g.vx = random.uniform(-0.3, 0.3);
        g.vy = random.uniform(-0.3, 0.3);
        g.density = 2000;
        engine->add(g);
      }
    }
    WallMotion lid;
    lid.servo.emplace();
    lid.servo->stress = stress;
    lid.servo->between = {{"left", "right"}};
    lid.servo->max_speed = 0.2;
    engine->set_wall_motion("lid", lid);
    engine->set_background_damping(40);
    engine->step(40000);
    engine->set_background_damping(damping);
  }
  double width() const {
    const auto walls = engine->walls();
    return walls[1].point.x() - walls[0].point.x();
  }
  double error() const { return engine->walls()[3].force.y() / (stress * width()) - 1; }
};

TEST(Servo, HoldsItsStressThroughACompression) {
  for (const AnyLaw& law :
       {AnyLaw(LinearLaw{1e6, 3e5, 500, 250}), AnyLaw(OverlapAreaLaw{1e6, 0.75})}) {
    const Press press(law, 0);
    EXPECT_NEAR(press.error(), 0, 1e-3);
    EXPECT_GT(press.engine->measure().contacts, 800);
    const double height = press.engine->walls()[3].point.y(), width = press.width();
    press.engine->set_wall_motion("left", {{0.01, 0, 0}, {0, 0, 0}, {}, 0.05});
    double worst = 0, sum = 0;
    const int steps = 10000;
    for (int k = 0; k < steps; ++k) {
      press.engine->step(1);
      const double error = press.error();
      worst = std::max(worst, std::fabs(error));
      sum += error;
    }
    EXPECT_LT(worst, 0.01);
    EXPECT_LT(std::fabs(sum / steps), 1e-3);
    EXPECT_NEAR(press.width(), width - 0.01 * (0.4 - 0.025), 1e-9);
    // The lid has given way.
    EXPECT_GT(press.engine->walls()[3].point.y(), height + 5e-4);
    RecordProperty("worst_per_mille", static_cast<int>(1000 * worst));
  }
}

TEST(Servo, TakesOverWithoutAJolt) {
  const Press press(LinearLaw{1e6, 3e5, 500, 250}, 0);
  press.engine->set_wall_motion("lid", {});
  press.engine->step(200);
  WallMotion lid;
  lid.servo.emplace();
  lid.servo->force = press.stress * press.width();
  lid.servo->max_speed = 0.2;
  press.engine->set_wall_motion("lid", lid);
  for (int k = 0; k < 500; ++k) {
    press.engine->step(1);
    EXPECT_LT(std::fabs(press.error()), 1e-3) << k;
  }
}

// Direct shear: the lid is drawn along itself under its load.
TEST(Servo, HoldsItsStressWhileItSlides) {
  const Press press(LinearLaw{1e6, 3e5, 500, 250}, 0);
  WallMotion draw;
  draw.velocity = {0.02, 0, 0};
  draw.ramp = 0.05;
  draw.servo.emplace();
  draw.servo->stress = press.stress;
  draw.servo->area = press.width();
  draw.servo->max_speed = 0.2;
  press.engine->set_wall_motion("lid", draw);
  double worst = 0;
  for (int k = 0; k < 5000; ++k) {
    press.engine->step(1);
    worst = std::max(worst, std::fabs(press.error()));
  }
  EXPECT_LT(worst, 0.01);
  const Wall lid = press.engine->walls()[3];
  EXPECT_NEAR(lid.force.x() / lid.force.y(), -0.1, 0.01);  // the grains' friction on it
  EXPECT_NEAR(lid.velocity.x(), 0.02, 1e-12);
}

// A cube of spheres between three walls at rest and three servos with one mean stress.
TEST(Servo, ThreeWallsPressACubeAlike) {
  EngineSettings s;
  s.law = HertzLaw{1e8, 0.3, 0.3};
  s.shape = ShapeKind::sphere;
  s.time_step = 1e-5;
  s.gravity_y = 0;
  s.friction = 0.2;
  const auto engine = make_engine(s);
  for (const Wall& w : box_walls({0, 0, 0}, {0.07, 0.07, 0.07}, 0, 3)) engine->add_wall(w);
  Random random(6);
  for (int k = 0; k < 216; ++k) {
    const auto at = [&](int cell) { return 0.0065 + 0.0114 * cell + random.uniform(-4e-4, 4e-4); };
    NewGrain g;
    g.radius = random.uniform(0.004, 0.0052);
    g.x = at(k % 6);
    g.y = at(k / 6 % 6);
    g.z = at(k / 36);
    g.vx = random.uniform(-0.5, 0.5);
    g.vy = random.uniform(-0.5, 0.5);
    g.density = 2500;
    engine->add(g);
  }
  const auto press = [&](const char* wall, std::array<std::string, 2> a,
                         std::array<std::string, 2> b) {
    WallMotion m;
    m.servo.emplace();
    m.servo->stress = 5e3;
    m.servo->between = {a, b};
    m.servo->max_speed = 0.3;
    engine->set_wall_motion(wall, m);
  };
  press("right", {"front", "back"}, {"floor", "lid"});
  press("back", {"left", "right"}, {"floor", "lid"});
  press("lid", {"left", "right"}, {"front", "back"});
  engine->set_background_damping(20);
  engine->step(30000);
  const auto walls = engine->walls();  // left, right, front, back, floor, lid
  const double x = walls[1].point.x(), y = walls[3].point.y(), z = walls[5].point.z();
  EXPECT_LT(std::max({x, y, z}), 0.068);
  EXPECT_NEAR(walls[1].force.x() / (y * z), 5e3, 5);
  EXPECT_NEAR(walls[3].force.y() / (x * z), 5e3, 5);
  EXPECT_NEAR(walls[5].force.z() / (x * y), 5e3, 5);
  for (int k = 0; k < 3; ++k) {  // in balance with the walls at rest
    EXPECT_NEAR((walls[2 * k].force + walls[2 * k + 1].force).norm(), 0, 0.01 * 5e3 * x * y);
  }
}

TEST(Servo, IsStableAtItsLargestGain) {
  // One grain between lid and floor: nothing else to give way.
  for (const double damping : {0.0, 500.0, 5000.0}) {
    EngineSettings s;
    s.law = LinearLaw{1e6, 0, damping, 0};
    s.time_step = 2e-5;
    s.gravity_y = 0;
    const auto engine = make_engine(s);
    for (const Wall& w : box_walls({0, 0, 0}, {1, 0.021, 0}, 0, 2)) engine->add_wall(w);
    NewGrain g;
    g.x = 0.5;
    g.y = 0.0101;
    g.radius = 0.01;
    g.density = 2500;
    engine->add(g);
    WallMotion lid;
    lid.servo.emplace();
    lid.servo->force = 50;
    lid.servo->max_speed = 0.05;
    lid.servo->gain = 1;
    engine->set_wall_motion("lid", lid);
    engine->step(40000);
    double worst = 0;
    for (int k = 0; k < 1000; ++k) {
      engine->step(1);
      worst = std::max(worst, std::fabs(engine->walls()[3].force.y() - 50));
    }
    EXPECT_LT(worst, 0.05) << damping;
  }
}

EngineSettings small_spheres() {
  EngineSettings s;
  s.law = LinearLaw{2e4, 6e3, 4000, 2000};
  s.shape = ShapeKind::sphere;
  s.time_step = 2e-5;
  s.gravity_y = 0;
  s.gravity_z = -9.81;
  s.friction = 0.4;
  return s;
}

TEST(RoundWalls, AHopperEmptiesThroughItsOutlet) {
  const auto engine = make_engine(small_spheres());
  engine->add_wall({"floor", {0, 0, -0.1}, {0, 0, 1}, 0.4});
  Wall hopper{"hopper", {0, 0, 0}, {0, 0, 1}, 0.2, "cone"};
  hopper.radius = 0.014;
  hopper.end_radius = 0.05;
  hopper.length = 0.05;
  engine->add_wall(hopper);
  Random random(4);
  int count = 0;
  for (int layer = 0; layer < 6; ++layer) {
    const double reach = 0.014 + 0.72 * (0.012 + 0.0075 * layer) - 0.006;
    for (double x = -0.05; x < 0.05; x += 0.0075) {
      for (double y = -0.05; y < 0.05; y += 0.0075) {
        if (std::hypot(x, y) > reach) continue;
        NewGrain g;
        g.radius = random.uniform(0.0025, 0.0035);
        g.x = x;
        g.y = y;
        g.z = 0.012 + 0.0075 * layer;
        g.density = 2500;
        engine->add(g);
        ++count;
      }
    }
  }
  ASSERT_GT(count, 200);
  int through = 0, half = 0;
  for (int part = 0; part < 40; ++part) {
    engine->step(1000);
    through = 0;
    for (const Grain& g : engine->snapshot().grains) {
      const double rho = std::hypot(g.position.x(), g.position.y());
      if (g.position.z() < 0) {
        ++through;
      } else {  // none has gone through the wall
        EXPECT_LT(rho, 0.014 + 0.72 * g.position.z() - 0.9 * g.radius / std::hypot(1, 0.72) + 1e-3);
      }
      EXPECT_GT(g.position.z(), -0.1 + 0.9 * g.radius);
    }
    if (part == 5) half = through;
  }
  EXPECT_LT(half, count - 20);  // it takes its time
  EXPECT_GT(through, count - 20);
}

TEST(RoundWalls, ALiftedCylinderLeavesAPile) {
  const auto engine = make_engine(small_spheres());
  engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.5});
  Wall tube{"tube", {0, 0, 0.0005}, {0, 0, 1}, 0.2, "cylinder"};
  tube.radius = 0.025;
  tube.length = 0.1;
  engine->add_wall(tube);
  Random random(4);
  for (int layer = 0; layer < 12; ++layer) {
    for (double x = -0.0175; x < 0.02; x += 0.007) {
      for (double y = -0.0175; y < 0.02; y += 0.007) {
        if (std::hypot(x, y) > 0.0205) continue;
        NewGrain g;
        g.radius = random.uniform(0.0025, 0.0033);
        g.x = x + random.uniform(-3e-4, 3e-4);
        g.y = y + random.uniform(-3e-4, 3e-4);
        g.z = 0.004 + 0.007 * layer;
        g.density = 2500;
        engine->add(g);
      }
    }
  }
  const auto spread = [&] {
    double most = 0, height = 0, out = 0;
    const Snapshot now = engine->snapshot();
    for (const Grain& g : now.grains) {
      const double rho = std::hypot(g.position.x(), g.position.y());
      most = std::max(most, rho + g.radius);
      height = std::max(height, g.position.z());
      out += rho > 0.03;
    }
    return std::array{most, height, out / static_cast<double>(now.grains.size())};
  };
  engine->set_background_damping(5);
  engine->step(15000);
  engine->set_background_damping(0);
  const auto before = spread();
  EXPECT_LT(before[0], 0.0252);
  engine->set_wall_motion("tube", {{0, 0, 0.2}, {0, 0, 0}, {}, 0.02});
  engine->step(30000);
  const auto after = spread();
  EXPECT_LT(after[1], 0.7 * before[1]);
  EXPECT_GT(after[2], 0.25);
  EXPECT_NEAR(engine->walls()[1].point.z(), 0.0005 + 0.2 * (0.6 - 0.01), 1e-9);
  EXPECT_NEAR(engine->walls()[1].force.norm(), 0, 1e-12);  // it is above all grains
}

}  // namespace
}  // namespace grainfield::dem
