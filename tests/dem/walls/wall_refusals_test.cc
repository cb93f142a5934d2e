// Motions of walls that cannot be: servos without sense, speeds at which walls jump over grains,
// checkpoints whose servos name walls that are not there.
#include <gmock/gmock.h>

#include <array>

#include "dem/walls/box.h"
#include "tests/dem/damaged_checkpoint.h"
#include "tests/dem/mesh_scene.h"
#include "tests/dem/wall_scene.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

TEST(WallRefusals, WhatCannotBe) {
  const auto refusal = [](const WallMotion& motion, double radius = kRadius) {
    const auto engine = make_engine(disks(LinearLaw{}, 1e-4));
    engine->add_wall({"lid", {0, 1, 0}, {0, -1, 0}, 0});
    engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0});
    engine->add(grain({0, 0, 0}, {0, 0, 0}, radius));
    try {
      engine->set_wall_motion("lid", motion);
      engine->step(1);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  WallMotion m;
  m.servo.emplace();
  m.servo->max_speed = 1;
  EXPECT_EQ(refusal(m),
            "wall lid: servo: found force 0 N and stress 0, allowed: one target above 0");
  m.servo->force = 10;
  EXPECT_EQ(refusal(m), "accepted");
  m.servo->max_speed = 0;
  EXPECT_EQ(refusal(m), "wall lid: servo: max_speed: found 0, allowed: above 0 m/s");
  m.servo->max_speed = 60;
  EXPECT_THAT(refusal(m), HasSubstr("wall lid: speed: found 60 m/s, allowed: up to 50 m/s, at "
                                    "which it passes half a radius of the smallest grain in a "
                                    "step; lower it or motion.time_step (now 0.0001 s)"));
  m.servo->max_speed = 1;
  m.servo->force = 0;
  m.servo->stress = 5;
  EXPECT_THAT(refusal(m), HasSubstr("wall lid: servo: area: found 0 and 0 pairs of walls"));
  m.servo->between = {{"left", "right"}};
  EXPECT_THAT(refusal(m), HasSubstr("found \"right\", allowed: the name of a plane"));
  m.servo->between = {{"left", "lid"}, {"left", "lid"}};
  EXPECT_THAT(refusal(m), HasSubstr("servo: between: found 2 pairs of walls, allowed: 1"));
  m.servo->between = {{"left", "left"}};
  EXPECT_EQ(refusal(m),
            "wall lid: servo: between: found \"left\" twice in a pair, allowed: two walls");
  m.servo->between = {{"left", "lid"}};
  EXPECT_EQ(refusal(m), "accepted");
  m.servo->force = 10;
  m.servo->stress = 0;
  EXPECT_EQ(refusal(m),
            "wall lid: servo: between: found 1 pairs of walls, allowed: none for a target force");
  m.servo->force = 0;
  m.servo->stress = 5;
  m.servo->between.clear();
  m.servo->area = 1;
  m.servo->gain = 3;
  EXPECT_THAT(refusal(m), HasSubstr("gain: found 3, allowed: above 0, at most 1"));
  m.servo.reset();
  m.velocity = {0, -51, 0};
  EXPECT_THAT(refusal(m), HasSubstr("wall lid: speed: found 51 m/s"));
  EXPECT_EQ(refusal(m, 2 * kRadius), "accepted");
  m.velocity = {51, 0, 0};  // along itself
  EXPECT_EQ(refusal(m), "accepted");
  m.velocity = {0, 0, 1};
  EXPECT_THAT(refusal(m), HasSubstr("a motion out of the plane"));
  const auto engine = make_engine(disks(LinearLaw{}, 1e-4));
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0});
  EXPECT_THROW(engine->set_wall_motion("flor", {}), std::invalid_argument);
  EXPECT_THROW(engine->set_wall_motion(1, {}), std::invalid_argument);
  EngineSettings polygons = disks(OverlapAreaLaw{}, 1e-5);
  polygons.shape = ShapeKind::polygon;
  Wall ring{"ring", {0, 0, 0}, {0, 1, 0}, 0, "cylinder"};
  ring.radius = 1;
  EXPECT_THROW(make_engine(polygons)->add_wall(ring), std::invalid_argument);
}

// Turning, a plane's speed depends on where the grain is: known when it gets there.
TEST(WallRefusals, AWallThatTurnsThroughGrainsTooFastFails) {
  const auto engine = make_engine(disks(LinearLaw{1e5, 0, 0, 0}, 1e-3));
  engine->add_wall({"paddle", {0, 0, 0}, {0, 1, 0}, 0});
  engine->set_wall_motion("paddle", moving({0, 0, 0}, {0, 0, 10}));
  engine->add(grain({1, 0.25, 0}, {0, 0, 0}));
  try {
    engine->step(100);
    FAIL();
  } catch (const ComputationFailed& e) {
    EXPECT_THAT(e.what(), HasSubstr("a wall goes through grains by more than half a radius a step; "
                                    "lower its speed or motion.time_step (now 0.001 s)"));
  }
}

// A wall that ends somewhere may not turn over grains either, wherever it is seen to.
TEST(WallRefusals, WallsThatTurnAcrossThemselvesTooFast) {
  const auto refusal = [](Wall wall, const Vec3& spin, const Vec3& centre,
                          const Vec3& v = {0, 0, 0}) {
    const bool space = wall.shape != "cylinder" || wall.length > 0;
    const LinearLaw law{1e5, 3e4, 0, 0};
    const auto engine = make_engine(space ? spheres(law, 1e-4) : disks(law, 1e-4));
    engine->add_wall(wall);
    engine->add(grain({5, 0, 0}, {0, 0, 0}));
    WallMotion m = moving(v, spin);
    m.centre = centre;
    engine->set_wall_motion(0, m);
    try {
      engine->step(1);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  const auto refused = [](const char* speed) {
    return std::string("wall wall: speed: found ") + speed +
           " m/s, allowed: up to 50 m/s, at which it passes half a radius of the smallest grain in "
           "a step; lower it or motion.time_step (now 0.0001 s)";
  };
  const Vec3 z(0, 0, 1), none(0, 0, 0);
  Wall blade{"wall", none, z, 0, "mesh"};
  blade.triangles = box_mesh({0, -0.05, -3}, {1, 0.05, 3}, false);
  EXPECT_EQ(refusal(blade, 49 * z, none), "accepted");  // by the arm from the axis
  EXPECT_EQ(refusal(blade, 51 * z, none), refused("51.06"));
  EXPECT_EQ(refusal(blade, 26 * z, Vec3(-1, 0, 0)), refused("52.02"));
  EXPECT_EQ(refusal(blade, 49 * z, none, Vec3(0, 0, 3)), refused("52.06"));
  // About its own axis a round wall stays where it is, however fast.
  Wall ring{"wall", none, z, 0, "cylinder"};
  ring.radius = 1;
  ring.inside = false;
  EXPECT_EQ(refusal(ring, 1000 * z, none), "accepted");
  EXPECT_EQ(refusal(ring, 1000 * z, Vec3(0.049, 0, 0)), "accepted");
  EXPECT_EQ(refusal(ring, 1000 * z, Vec3(0.051, 0, 0)), refused("51"));
  for (const char* shape : {"cylinder", "cone"}) {
    Wall shell{"wall", none, z, 0, shape};
    shell.radius = shell.end_radius = 0.5;
    shell.length = 2;
    EXPECT_EQ(refusal(shell, 1000 * z, none), "accepted") << shape;
    EXPECT_EQ(refusal(shell, 1000 * z, Vec3(0.5, 0, 0)), refused("1000")) << shape;
    EXPECT_EQ(refusal(shell, Vec3(21, 0, 0), none), refused("52.5")) << shape;
  }
}

// The walls between which a servo measures its area stand in a checkpoint by their numbers.
TEST(WallRefusals, CheckpointsWhoseServosNameNoWall) {
  for (const bool space : {false, true}) {
    const auto boxed = [&] {
      const LinearLaw law{1e5, 3e4, 0, 0};
      auto engine = make_engine(space ? spheres(law, 1e-5) : disks(law, 1e-5));
      for (const Wall& w : box_walls({0, 0, 0}, {1, 1, 1}, 0, space ? 3 : 2)) engine->add_wall(w);
      return engine;
    };
    const auto engine = boxed();
    WallMotion lid;
    lid.servo.emplace();
    lid.servo->stress = 5;
    lid.servo->max_speed = 0.1;
    lid.servo->between = {{"left", "right"}};
    if (space) lid.servo->between.push_back({"front", "back"});
    engine->set_wall_motion("lid", lid);
    engine->step(1);
    const std::string checkpoint = engine->checkpoint();
    using Indices = std::array<int, 4>;  // of the first walls of the pairs, of the second ones
    const Indices right = space ? Indices{0, 2, 1, 3} : Indices{0, -1, 1, -1};
    const std::size_t at = checkpoint.find(bytes_of(right));
    ASSERT_NE(at, std::string::npos);
    const auto refusal = [&](int place, int wall) {
      Indices wrong = right;
      wrong[place] = wall;
      return refusal_with(*boxed(), checkpoint, at, wrong);
    };
    const int walls = space ? 6 : 4;
    EXPECT_EQ(refusal(0, 2), "accepted");
    for (const int wall : {-2, -1, walls, 1 << 20}) {
      EXPECT_EQ(refusal(0, wall), kBrokenCheckpoint) << wall;
      EXPECT_EQ(refusal(2, wall), kBrokenCheckpoint) << wall;
      if (wall == -1 && !space) continue;  // the plane has one pair
      EXPECT_EQ(refusal(1, wall), kBrokenCheckpoint) << wall;
      EXPECT_EQ(refusal(3, wall), kBrokenCheckpoint) << wall;
    }
    EXPECT_EQ(refusal(1, 0), space ? "accepted" : kBrokenCheckpoint);
  }
}

}  // namespace
}  // namespace grainfield::dem
