// What single contacts remember of rolling: at walls that turn or have corners, through searches
// and when they open.
#include <gmock/gmock.h>

#include "tests/dem/mesh_scene.h"
#include "tests/dem/rolling_scene.h"

namespace grainfield::dem {
namespace {

// Without friction the law remembers nothing, rolling does: a sphere in the edge of a mesh, first
// deeper in the floor and then in the wall, keeps at each what it remembers when the list is made
// anew.
TEST(RollingContacts, GoWithTheirPlaceInACornerOfAMesh) {
  EngineSettings s = settings_of(true, {300, 0, 0.5});
  s.friction = 0;
  s.gravity_y = -3;
  s.gravity_z = -kGravity;
  const auto engine = make_engine(s);
  Wall box{"box", {0, 0, 0}, {0, 0, 1}, 0, "mesh"};
  box.triangles = box_mesh({0, 0, 0}, {1, 1, 1}, true);
  engine->add_wall(box);
  const double depth = mass_of(true) / 1e4;  // by 1 m/s2
  NewGrain g;
  g.radius = kRadius;
  g.density = 2500;
  g.x = 0.4;
  g.y = kRadius - 3 * depth;
  g.z = kRadius - kGravity * depth;
  g.spin_x = 0.5;
  engine->add(g);
  engine->step(200);
  EXPECT_EQ(engine->snapshot().contacts.at(0).normal, Vec3(0, 0, -1));  // towards the wall
  engine->set_gravity(0, -kGravity, -3);
  engine->step(200);
  const std::vector<Contact> before = engine->snapshot().contacts;
  g.x = 0.8;  // far away
  g.y = g.z = 0.5;
  g.spin_x = 0;
  engine->add(g);
  engine->step(1);
  const std::vector<Contact> after = engine->snapshot().contacts;
  ASSERT_EQ(before.size(), 2U);
  ASSERT_EQ(after.size(), 2U);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(before[k].normal, k == 0 ? Vec3(0, -1, 0) : Vec3(0, 0, -1));
    EXPECT_TRUE(before[k].spring_vector.isZero(0));
    const double size = before[k].rolling_spring.norm();
    EXPECT_GT(size, 1e-3);
    EXPECT_LT((after[k].rolling_spring - before[k].rolling_spring).norm(), 0.02 * size) << k;
  }
}

// New grains are started with forces at no time: what the other contacts remember stays.
TEST(RollingContacts, StayAsTheyAreWhenAGrainIsAdded) {
  for (const bool space : {false, true}) {
    const bits::Scene scene = crowd(space);
    const auto springs = [&](bool with_new) {
      const auto engine = make_engine(scene.settings);
      for (const Wall& wall : scene.walls) engine->add_wall(wall);
      for (const NewGrain& g : scene.grains) engine->add(g);
      engine->step(3000);
      NewGrain g;
      g.radius = 0.003;
      g.density = 2500;
      (space ? g.z : g.y) = 0.045;  // above the others
      g.material = "glass";
      if (with_new) engine->add(g);
      engine->step(1);
      std::vector<Vec3> out;
      for (const Contact& c : engine->snapshot().contacts) out.push_back(c.rolling_spring);
      return out;
    };
    const std::vector<Vec3> alone = springs(false), with_new = springs(true);
    ASSERT_EQ(with_new.size(), alone.size());
    double most = 0;
    for (const Vec3& spring : alone) most = std::max(most, spring.norm());
    EXPECT_GT(most, 1e-4);
    for (std::size_t k = 0; k < alone.size(); ++k) {
      EXPECT_LT((with_new[k] - alone[k]).norm(), 1e-9 * most) << space << ' ' << k;
    }
  }
}

// A floor turns about the point where a grain lies: the spring of rolling holds what it takes.
TEST(RollingContacts, HoldTheWorkOfAWallThatTurns) {
  for (const bool space : {false, true}) {
    EngineSettings s = settings_of(space, {space ? 50.0 : 5e3, 0, 100});
    s.law = LinearLaw{space ? 1e4 : 1e6, 0, 0, 0};
    s.energy_balance = true;
    (space ? s.gravity_z : s.gravity_y) = -kGravity;
    const auto engine = on_floor(s, mass_of(space) * kGravity);
    const double turning = 1;
    const WallMotion motion{{0, 0, 0}, turning * Vec3::UnitX().cross(up(space))};
    engine->set_wall_motion("floor", motion);
    engine->step(1000);
    const Diagnostics before = engine->measure();
    EXPECT_GT(before.wall_work, 1e-7);
    EXPECT_LT(std::fabs(before.dissipated_energy()), 1e-2 * before.wall_work) << space;
    EXPECT_LT(std::fabs(before.contact_losses.law), 1e-2 * before.wall_work) << space;
    // Told again, it takes over the moment as it is.
    const double moment = engine->snapshot().contacts.at(0).rolling_spring.norm() * kRadius;
    engine->set_wall_motion("floor", motion);
    engine->step(1);
    EXPECT_NEAR(engine->measure().energy_balance(), before.energy_balance(),
                0.1 * moment * turning * s.time_step)
        << space;
  }
}

// A grain that falls on another one, also across the face of a cell, and bounces: the second touch
// knows nothing of the first.
TEST(RollingContacts, ForgetWhenTheyOpen) {
  for (const bool across : {false, true}) {
    EngineSettings s = settings_of(false, {1e5, 0, 1});
    s.law = LinearLaw{1e6, 0, 0, 0};
    s.gravity_x = 25;
    s.skin = 0.1;  // the pair stays in the list
    s.cell.periodic[0] = true;
    s.cell.edges.col(0) = Vec3::UnitX();
    const auto engine = make_engine(s);
    NewGrain g;
    g.radius = kRadius;
    g.density = 2500;
    g.fixed = true;
    g.x = across ? 0.005 : 0.505;
    engine->add(g);
    g.fixed = false;
    g.x -= across ? -0.96 : 0.04;
    g.spin = 20;
    engine->add(g);
    double most = 0;
    int touches = 0;
    for (bool touched = false; touches < 2 && engine->steps() < 40000;) {
      engine->step(1);
      const Snapshot now = engine->snapshot();
      if (now.contacts.empty()) {
        touched = false;
        continue;
      }
      const double spring = now.contacts[0].rolling_spring.norm();
      most = std::max(most, spring);
      if (!touched) {
        // One step of rolling with both radii alike.
        const double grown = 1e5 * 0.5 * kRadius * std::fabs(now.grains[1].spin) * s.time_step;
        EXPECT_LE(spring, 1.01 * grown) << across << ' ' << touches;
        ++touches;
      }
      touched = true;
    }
    EXPECT_EQ(touches, 2);
    EXPECT_GT(most, 10);
  }
}

}  // namespace
}  // namespace grainfield::dem
