// Walls that move or are no plane: frames of reference, carrying by friction, meshes against
// planes, corners, Hertz' law on curved walls, sleepers, the same bits.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/shapes/polygon.h"
#include "dem/space/space3.h"
#include "dem/walls/box.h"
#include "tests/dem/bits_scene.h"
#include "tests/dem/mesh_scene.h"
#include "tests/dem/wall_scene.h"

namespace grainfield::dem {
namespace {

// A collision with a wall that moves, and in the frame in which the wall is at rest.
TEST(WallMotion, AMovingWallIsACollisionInItsFrame) {
  for (const int kind : {0, 1, 2}) {  // disk, sphere, polygon
    const bool space = kind == 1;
    const LinearLaw law{1e6, 3e5, 800, 400};
    EngineSettings s = space ? spheres(law, 1e-5) : disks(law, 1e-5);
    if (kind == 2) s.shape = ShapeKind::polygon;
    const Vec3 n = space ? Vec3(0.48, 0.6, 0.64) : Vec3(0.6, 0.8, 0);
    const Vec3 frame = space ? Vec3(0.3, -0.2, 0.9) : Vec3(0.3, 0.7, 0);
    const Vec3 v = -1.5 * n + (space ? Vec3(0.1, 0.7, 0.2) : Vec3(0.7, -0.1, 0));
    const auto run = [&](const Vec3& wall_velocity) {
      const auto engine = make_engine(s);
      engine->add_wall({"wall", {0, 0, 0}, n, 0.4});
      if (wall_velocity.norm() > 0) engine->set_wall_motion("wall", moving(wall_velocity));
      NewGrain g = grain(1.02 * kRadius * n, v + wall_velocity);
      g.spin = 7;
      if (kind == 2) {
        g.outline = {{0.009, -0.008}, {0.011, 0.007}, {-0.008, 0.009}, {-0.01, -0.007}};
        g.outline = centred_outline(g.outline);
      }
      engine->add(g);
      engine->step(400);
      return engine->snapshot().grains[0];
    };
    const Grain still = run({0, 0, 0}), moved = run(frame);
    EXPECT_GT(still.velocity.dot(n), 0.1);  // it has bounced, and has been turned by friction
    EXPECT_GT(std::fabs(still.spin - 7), 1);
    EXPECT_NEAR((moved.velocity - frame - still.velocity).norm(), 0, 1e-11);
    EXPECT_NEAR((moved.position - 400 * 1e-5 * frame - still.position).norm(), 0, 1e-13);
    EXPECT_NEAR((moved.angular_velocity - still.angular_velocity).norm(), 0, 1e-9);
    EXPECT_NEAR(moved.spin, still.spin, 1e-9);
  }
}

// At the bottom of a drum that turns: friction first turns the grain, then it rolls in place.
TEST(WallMotion, ADrumTurnsWhatRestsInIt) {
  for (const bool space : {false, true}) {
    EngineSettings s = space ? spheres(LinearLaw{1e6, 3e5, 500, 300}, 1e-5)
                             : disks(LinearLaw{1e6, 3e5, 500, 300}, 1e-5);
    s.gravity_y = -9.81;
    const auto engine = make_engine(s);
    Wall drum{"drum", {0, 0, 0}, {0, 0, 1}, 0.5, "cylinder"};
    drum.radius = 0.1;
    engine->add_wall(drum);
    engine->set_wall_motion("drum", {{0, 0, 0}, {0, 0, 2}, {}, 0.05});
    engine->add(grain({0, -0.09, 0}, {0, 0, 0}));
    engine->set_background_damping(5);  // so that it stays near the bottom
    engine->step(200000);
    const Grain g = engine->snapshot().grains[0];
    // No slip: the wall moves by 2 R to the right at the bottom, the grain's rim with it.
    EXPECT_NEAR(g.velocity.x() - g.spin * -kRadius, 2 * 0.1, 2e-3) << space;
    EXPECT_GT(g.spin, 15);
    EXPECT_NEAR(std::hypot(g.position.x(), g.position.y()), 0.09, 1e-5);
    EXPECT_LT(g.velocity.norm(), 0.01);
    const Wall now = engine->walls()[0];
    EXPECT_NEAR(now.angular_velocity.z(), 2, 1e-12);
    const double mass = g.mass;
    EXPECT_NEAR(now.force.y(), -9.81 * mass, 1e-3 * 9.81 * mass);
    // The torque that the damping takes: carried by friction at the arm R.
    EXPECT_LT(now.torque.z(), 0);
  }
}

// A plane that tilts about a point: grains on it are lifted as it says.
TEST(WallMotion, ATurningPlaneLiftsWhatLiesOnIt) {
  EngineSettings s = disks(LinearLaw{1e6, 3e5, 500, 300}, 1e-5);
  s.gravity_y = -9.81;
  const auto engine = make_engine(s);
  engine->add_wall({"floor", {-1, 0, 0}, {0, 1, 0}, 5});
  WallMotion tilt = moving({0, 0, 0}, {0, 0, 0.2});
  tilt.centre = Vec3(0.2, 0, 0);
  engine->set_wall_motion(0, tilt);
  NewGrain block = grain({0.5, kRadius, 0}, {0, 0, 0});
  block.rotates = false;
  engine->add(block);
  engine->step(50000);
  const Grain g = engine->snapshot().grains[0];
  // Seen from the plane it turns back, and rolls up by kRadius * angle.
  const double angle = 0.1, along = 0.3 + kRadius * angle;
  EXPECT_NEAR(g.position.x(), 0.2 + along * std::cos(angle) - kRadius * std::sin(angle), 3e-5);
  EXPECT_NEAR(g.position.y(), along * std::sin(angle) + kRadius * std::cos(angle), 3e-5);
  const Wall floor = engine->walls()[0];
  EXPECT_NEAR((floor.normal - Vec3(-std::sin(angle), std::cos(angle), 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(floor.point.y(), -1.2 * std::sin(angle), 1e-12);
  // From a snapshot it moves on as it did, about its point now.
  const auto next = make_engine(s, engine->snapshot());
  next->step(1000);
  engine->step(1000);
  const Wall there = engine->walls()[0], here = next->walls()[0];
  EXPECT_NEAR((there.normal - here.normal).norm(), 0, 1e-12);
  EXPECT_NEAR((there.point - here.point).norm(), 0, 1e-5);  // straight on instead of round
  EXPECT_NEAR((there.velocity - here.velocity).norm(), 0, 3e-3 * there.velocity.norm());
  EXPECT_EQ(there.angular_velocity, here.angular_velocity);
  // Stopped, it is a plane at rest where it is.
  engine->set_wall_motion("floor", {});
  engine->step(30000);
  EXPECT_EQ(engine->walls()[0].velocity, Vec3(0, 0, 0));
  EXPECT_EQ(engine->walls()[0].point, there.point);
  EXPECT_NEAR(engine->walls()[0].force.norm(), 9.81 * g.mass, 0.02 * 9.81 * g.mass);
}

// Two triangles are the plane in which they lie, while a sphere rolls over their edge.
TEST(WallMotion, AMeshOfTwoTrianglesIsAPlane) {
  const auto run = [](bool mesh, const Vec3& drift, int steps) {
    EngineSettings s = spheres(HertzLaw{1e8, 0.3, 0.2}, 1e-5);
    s.gravity_z = -9.81;
    const auto engine = make_engine(s);
    Wall floor{"floor", {0, 0, 0}, {0, 0, 1}, 0.5};
    if (mesh) {
      floor.shape = "mesh";
      floor.triangles = {{Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0)},
                         {Vec3(-1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)}};
    }
    engine->add_wall(floor);
    if (drift.norm() > 0) engine->set_wall_motion(0, moving(drift));
    NewGrain g = grain({0.01, 0, 0.01 - 6e-6}, Vec3(-0.5, 0.3, 0) + drift);
    g.spin_x = 20;
    engine->add(g);
    std::vector<Vec3> forces;
    for (int k = 0; k < steps; ++k) {
      engine->step(1);
      const Snapshot now = engine->snapshot();
      EXPECT_LE(now.contacts.size(), 1U);
      forces.push_back(now.contacts.empty() ? Vec3(0, 0, 0) : now.contacts[0].force);
    }
    const Snapshot end = engine->snapshot();
    EXPECT_LT(end.grains[0].position.x(), end.grains[0].position.y() + drift.x());
    return forces;
  };
  for (const Vec3& drift : {Vec3(0, 0, 0), Vec3(0.2, 0.1, 0.3)}) {
    const auto plane = run(false, drift, 4000), mesh = run(true, drift, 4000);
    double most = 0, touching = 0;
    for (const Vec3& f : plane) most = std::max(most, f.norm());
    for (std::size_t k = 0; k < plane.size(); ++k) {
      ASSERT_NEAR((plane[k] - mesh[k]).norm(), 0, 1e-9 * most) << k;
      touching += plane[k].norm() > 0;
    }
    EXPECT_GT(touching, 2000);
    EXPECT_LT((plane[0] - mesh[0]).norm(), 1e-13 * most);
  }
}

TEST(WallMotion, ASphereLiesInTheCornerOfAMesh) {
  const auto run = [](bool mesh) {
    EngineSettings s = spheres(LinearLaw{1e6, 3e5, 500, 300}, 1e-5);
    s.gravity_x = -3;
    s.gravity_y = -4;
    s.gravity_z = -9;
    const auto engine = make_engine(s);
    if (mesh) {
      Wall box{"box", {0.3, 0.1, 0}, {0, 0, 1}, 0.3, "mesh"};
      box.triangles = box_mesh({0, 0, 0}, {1, 1, 1}, true);
      engine->add_wall(box);
    } else {
      for (const Wall& w : box_walls({0, 0, 0}, {1, 1, 1}, 0.3, 3)) engine->add_wall(w);
    }
    engine->add(grain({0.0101, 0.0101, 0.0101}, {-0.1, 0.1, 0}));
    engine->set_background_damping(50);
    engine->step(20000);
    const Snapshot now = engine->snapshot();
    EXPECT_EQ(now.contacts.size(), 3U);
    Vec3 sum(0, 0, 0);
    for (const Wall& w : now.walls) sum += w.force;
    EXPECT_NEAR((sum - now.grains[0].mass * Vec3(-3, -4, -9)).norm(), 0, 1e-4 * now.grains[0].mass);
    // It goes on from the checkpoint and from the snapshot as it is.
    for (const bool snapshot : {false, true}) {
      auto next = snapshot ? make_engine(s, now) : make_engine(s);
      if (!snapshot) {
        for (const Wall& w : now.walls) next->add_wall(w);
        next->restore(engine->checkpoint());
      }
      next->step(1);
      const Snapshot after = next->snapshot();
      EXPECT_EQ(after.contacts.size(), 3U);
      for (std::size_t k = 0; k < after.contacts.size(); ++k) {
        EXPECT_NEAR((after.contacts[k].force - now.contacts[k].force).norm(), 0, 1e-3) << k;
        EXPECT_NEAR((after.contacts[k].spring_vector - now.contacts[k].spring_vector).norm(), 0,
                    1e-4)
            << k;
      }
    }
    return now.grains[0];
  };
  const Grain mesh = run(true), planes = run(false);
  EXPECT_NEAR((mesh.position - planes.position).norm(), 0, 1e-10);
}

// Force at a given depth in round walls, by formula.
TEST(WallMotion, HertzOnRoundWalls) {
  const HertzLaw law{1e9, 0.25, 0};
  for (const bool inside : {true, false}) {
    const auto engine = make_engine(spheres(law, 1e-8));
    Wall tube{"tube", {0, 0, 0}, {0, 0, 1}, 0, "cylinder"};
    tube.radius = 0.02;
    tube.inside = inside;
    engine->add_wall(tube);
    const double depth = 1e-5;
    engine->add(grain({inside ? 0.01 + depth : 0.03 - depth, 0, 0.3}, {0, 0, 0}));
    engine->step(1);
    const Snapshot now = engine->snapshot();
    // B/A = 2 and 3/2: R from the elliptic integrals, as in wall_surface_test.cc.
    const double r = effective_radius(0.01, (inside ? -1 : 1) / 0.02);
    EXPECT_NEAR(r, inside ? 0.01443 : 0.0082, 3e-5);
    const double force = 4.0 / 3 * law.effective_young() * std::sqrt(r) * std::pow(depth, 1.5);
    ASSERT_EQ(now.contacts.size(), 1U);
    EXPECT_NEAR(now.contacts[0].normal_force, force, 1e-6 * force);
  }
}

// A row of sleepers before a piston.
TEST(WallMotion, WakesSleepersBeforeItTouchesThem) {
  EngineSettings s = disks(OverlapAreaLaw{1e6, 0.75}, 2e-5);
  s.gravity_y = -9.81;
  s.sleep.on = true;
  s.sleep.quiet_move = 1e-2;
  const auto engine = make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.1});
  engine->add_wall({"piston", {-0.02, 0, 0}, {1, 0, 0}, 0.1});
  for (int k = 0; k < 4; ++k) engine->add(grain({0.021 * k, kRadius, 0}, {0, 0, 0}));
  engine->step(20000);
  ASSERT_EQ(engine->measure().awake, 0);
  engine->set_wall_motion("piston", moving({0.02, 0, 0}));
  EXPECT_EQ(engine->measure().awake, 4);
  double deepest = 0;
  int least = 4;
  for (int k = 0; k < 100; ++k) {
    engine->step(500);
    deepest = std::max(deepest, engine->measure().max_overlap_ratio);
    least = std::min(least, engine->measure().awake);
  }
  EXPECT_LT(least, 3);  // those far from it have slept again
  EXPECT_LT(deepest, 0.02);
  EXPECT_NEAR(engine->walls()[1].point.x(), 0, 1e-12);
  EXPECT_GT(engine->snapshot().grains[0].position.x(), kRadius - 2e-4);
  EXPECT_GT(engine->snapshot().grains[1].position.x(), 0.021 + 0.008);
}

// Two quarter turns about different axes do not commute.
TEST(WallMotion, TurnsAboutOneAxisAfterTheOther) {
  const auto engine = make_engine(spheres(LinearLaw{}, 1e-4));
  engine->add_wall({"wall", {1, 0, 0}, {1, 0, 0}, 0});
  const double rate = 0.5 * std::numbers::pi / (1000 * 1e-4);
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0)}) {
    engine->set_wall_motion(0, {{0, 0, 0}, rate * axis, Vec3(0, 0, 0)});
    engine->step(1000);
  }
  EXPECT_NEAR((engine->walls()[0].normal - Vec3(0, 0, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR((engine->walls()[0].point - Vec3(0, 0, 1)).norm(), 0, 1e-12);
}

TEST(WallMotion, RampsBeginWhenTheyAreSet) {
  const auto engine = make_engine(disks(LinearLaw{}, 1e-4));
  engine->add_wall({"lid", {0, 1, 0}, {0, -1, 0}, 0});
  engine->step(3000);
  engine->set_wall_motion("lid", {{0, -0.4, 0}, {0, 0, 0}, {}, 0.1});
  engine->step(500);
  EXPECT_NEAR(engine->walls()[0].velocity.y(), -0.2, 1e-3);
  engine->step(500);
  EXPECT_NEAR(engine->walls()[0].velocity.y(), -0.4, 1e-4);
  EXPECT_NEAR(engine->walls()[0].point.y(), 1 - 0.5 * 0.4 * 0.1, 1e-6);
}

// One that passes more than the reach of the sleepers' guard between two reviews.
TEST(WallMotion, AFastWallWakesASleeperInTime) {
  EngineSettings s = disks(OverlapAreaLaw{1e6, 0.75}, 2e-5);
  s.gravity_y = -9.81;
  s.sleep.on = true;
  const auto engine = make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
  engine->add_wall({"piston", {-2, 0, 0}, {1, 0, 0}, 0});
  engine->add(grain({0, kRadius, 0}, {0, 0, 0}));
  engine->set_wall_motion("piston", moving({4, 0, 0}));
  bool slept = false;
  double height = 1;  // of the grain over the piston, in radii
  while (height > 0.99) {
    engine->step(1);
    slept |= engine->motion().awake == 0;
    if (engine->walls()[1].point.x() < -0.2) continue;
    height = (engine->snapshot().grains[0].position.x() - engine->walls()[1].point.x()) / kRadius;
    EXPECT_TRUE(height > 1 || engine->motion().awake == 1) << height;
  }
  EXPECT_TRUE(slept);
}

// A servo, a mesh that shakes, a cylinder that turns; threads, batches of steps, restarts.
TEST(WallMotion, SameBitsOnAnyThreadsAndAfterARestart) {
  const auto run = [](bool space, int threads, long cut, long batch) {
    EngineSettings s =
        space ? spheres(HertzLaw{1e7, 0.3, 0.3}, 2e-5) : disks(OverlapAreaLaw{1e6, 0.75}, 2e-5);
    (space ? s.gravity_z : s.gravity_y) = -9.81;
    s.threads = threads;
    s.energy_balance = true;
    const auto walled = [&](std::unique_ptr<Engine> engine) {
      const Vec3 up = space ? Vec3::UnitZ() : Vec3::UnitY();
      Wall ring{"ring", {0, 0, 0}, up, 0.4, "cylinder"};
      ring.radius = 0.1;
      engine->add_wall(ring);
      engine->add_wall({"lid", 0.12 * up, -up, 0.2});
      if (space) {
        Wall floor{"floor", {0, 0, 0}, up, 0.4, "mesh"};
        floor.triangles = box_mesh({-0.2, -0.2, -0.2}, {0.2, 0.2, 0}, false);
        engine->add_wall(floor);
      }
      return engine;
    };
    auto engine = walled(make_engine(s));
    engine->set_wall_motion("ring", {{0, 0, 0}, space ? Vec3(0, 0, 3) : Vec3(0, 0, 3), {}, 0.01});
    WallMotion lid;
    lid.servo.emplace();
    lid.servo->force = space ? 4 : 30;
    lid.servo->max_speed = 1.5;
    engine->set_wall_motion("lid", lid);
    if (space) engine->set_wall_motion("floor", {{0.05, 0, 0.02}, {0.3, 0.1, 0}, {}, 0.02});
    Random random(11);
    for (int k = 0; k < 80; ++k) {
      const auto place = [&] { return random.uniform(-0.065, 0.065); };
      const double r = random.uniform(0.006, 0.012);
      NewGrain g = grain({place(), place(), space ? random.uniform(0.01, 0.09) : 0},
                         {random.uniform(-2, 2), random.uniform(-2, 2), 0}, r);
      engine->add(g);
    }
    engine->set_background_damping(30);
    const long end = 6000;
    while (engine->steps() < end) {
      if (engine->steps() == cut) {
        const std::string checkpoint = engine->checkpoint();
        engine = walled(make_engine(s));
        engine->restore(checkpoint);
      }
      long next = std::min(end, engine->steps() + batch);
      if (engine->steps() < cut) next = std::min(next, cut);
      engine->step(next - engine->steps());
    }
    const Snapshot now = engine->snapshot();
    bits::Hash h;
    h.add(bits::hash_of(now));
    const Diagnostics d = engine->measure();
    for (const double x : {d.wall_work, d.dissipated_energy(), d.damped_energy}) h.add(x);
    int touched = 0;
    for (const Wall& w : now.walls) {
      h.add(w.point);
      h.add(w.normal);
      h.add(w.velocity);
      h.add(w.force);
      h.add(w.torque);
      touched += w.force.norm() > 0;
    }
    EXPECT_EQ(touched, space ? 3 : 2);
    EXPECT_GT(d.contacts, 30);
    return h.value();
  };
  for (const bool space : {false, true}) {
    const std::uint64_t one = run(space, 1, -1, 5000);
    EXPECT_TRUE(run(space, 3, -1, 5000) == one) << space;
    EXPECT_TRUE(run(space, 2, 2777, 5000) == one) << space;
    EXPECT_TRUE(run(space, 1, -1, 61) == one) << space;
  }
}

}  // namespace
}  // namespace grainfield::dem
