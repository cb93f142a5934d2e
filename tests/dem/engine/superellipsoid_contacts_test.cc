// Superellipsoids in the engine: beside spheres, on walls, energy, the same bits, cells, snapshots.
//
// The gas of docs/contact-laws.md:
// build/release/tests/dem_engine superellipsoid_contacts_test --gtest_filter='*Gas*'
// --gtest_output=xml:gas.xml
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/shapes/superellipsoid_store.h"
#include "tests/dem/bits_scene.h"
#include "tests/dem/gas_scene.h"

namespace grainfield::dem {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

using gas::add_box, gas::add_gas, gas::energy_of, gas::grain_of, gas::settings_of;

// Round superellipsoids are spheres: the same motion under all laws of both, to round-off's growth.
TEST(SuperellipsoidEngine, RoundOnesMoveAsSpheresDo) {
  for (const AnyLaw& law :
       {AnyLaw(PenaltyLaw{1e3, 500, 0.2}), AnyLaw(HertzEllipticLaw{1e4, 0.3, 0.2})}) {
    const auto run = [&](ShapeKind shape) {
      EngineSettings s = settings_of(law, 2e-4);
      s.shape = shape;
      s.friction = 0.4;
      s.gravity_z = -1;
      const auto engine = make_engine(s);
      engine->add_wall({"floor", {0, 0, -0.98}, {0, 0, 1}, 0.3});
      Random random(3);
      for (int k = 0; k < 8; ++k) {
        NewGrain g = grain_of(superellipsoid({1, 1, 1}, {1, 1}),
                              1.95 * Vector3d(k % 2, k / 2 % 2, k / 4), RotationOf<3>::Identity());
        g.radius = 1;
        g.vx = random.uniform(-1, 1);
        g.spin = random.uniform(-1, 1);
        engine->add(g);
      }
      engine->step(500);
      EXPECT_GT(engine->measure().contacts, 3);
      return engine->snapshot();
    };
    const Snapshot spheres = run(ShapeKind::sphere), same = run(ShapeKind::superellipsoid);
    // A sphere's contact with the floor acts on the plane, not in the middle of the overlap: below
    // 1e-3 of the lever.
    for (std::size_t k = 0; k < spheres.grains.size(); ++k) {
      const Grain &a = spheres.grains[k], &b = same.grains[k];
      EXPECT_NEAR((a.position - b.position).norm(), 0, 2e-4) << k;
      EXPECT_NEAR((a.velocity - b.velocity).norm(), 0, 5e-3) << k;
    }
  }
}

// On a plane a grain's force is that of its support function, and turns it: an ellipsoid swings
// about the upright position as its potential energy says.
TEST(SuperellipsoidEngine, OnAPlaneItRestsOnItsSupportPoint) {
  EngineSettings s = settings_of(PenaltyLaw{1e5, 0, 0}, 1e-4);
  s.gravity_z = -1;
  const Superellipsoid body = superellipsoid({0.6, 0.8, 1.2}, {0.8, 1.2});
  const auto turn = quaternion_of(Vector3d(0.3, 0.7, 0.1));
  const Vector3d down = turn.conjugate() * Vector3d(0, 0, -1);
  const Support support = support_of(body, down);
  const auto engine = make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0});
  engine->add(grain_of(body, {0, 0, support.height - 1e-4}, turn));
  engine->step(1);
  const Snapshot now = engine->snapshot();
  ASSERT_EQ(now.contacts.size(), 1U);
  const Contact& c = now.contacts[0];
  EXPECT_NEAR(c.normal_force, 1e5 * 1e-4, 1e-2);
  EXPECT_NEAR((c.point - now.grains[0].position - turn * support.point).norm(), 0, 1e-4);
  // Angular acceleration = I^-1 (x cross F).
  const Vector3d torque = (turn * support.point).cross(Vector3d(0, 0, 10));
  const Solid<3> solid = solid_of(body);
  const Vector3d rate = turn * Vector3d((turn.conjugate() * torque).cwiseQuotient(solid.moments));
  EXPECT_NEAR((now.grains[0].angular_velocity - 1e-4 * rate).norm(), 0, 2e-3 * 1e-4 * rate.norm());
}

// The penalty law is the gradient of c_N d^2/2 as the depth is the least thickness: without damping
// and friction a gas keeps its energy, however it rolls.
TEST(SuperellipsoidEngine, PenaltyGasKeepsItsEnergy) {
  const auto engine = make_engine(settings_of(PenaltyLaw{2e3, 0, 0}, 5e-4));
  const double edge = 3 * 2.6;
  add_box(*engine, edge);
  add_gas(*engine, 3, 2.6, 0.7, 1.3, 2);
  const auto [worst, contacts] = gas::drift_of(*engine, 100, 1000);
  RecordProperty("drift", fmt::format("{:.2e}", worst));
  RecordProperty("contacts", contacts);
  EXPECT_GT(contacts, 300);
  EXPECT_LT(worst, 1e-3);
}

// The elliptic Hertz law is no gradient: its force goes by the curvatures, which change as grains
// roll on each other. Its gas gains 7 % of its energy in 40,000 steps, and 11 % in twice as many of
// half the length: it is not the integrator's, whose drift would be a quarter. Collisions make the
// number one of its last bits, within the bounds.
TEST(SuperellipsoidEngine, HertzGasDrifts) {
  const auto drift = [](double step, long steps) {
    const auto engine = make_engine(settings_of(HertzEllipticLaw{1e4, 0.3, 0}, step));
    add_box(*engine, 3 * 2.6);
    add_gas(*engine, 3, 2.6, 0.7, 1.3, 2);
    return gas::drift_of(*engine, 40, steps).worst;
  };
  const double worst = drift(5e-4, 1000), finer = drift(2.5e-4, 2000);
  RecordProperty("drift", fmt::format("{:.4f}", worst));
  RecordProperty("drift_at_half_the_step", fmt::format("{:.4f}", finer));
  EXPECT_GT(worst, 0.02);
  EXPECT_LT(worst, 0.2);
  EXPECT_GT(finer, 0.5 * worst);
  EXPECT_LT(finer, 3 * worst);
}

TEST(SuperellipsoidEngine, MomentumAndAngularMomentumStay) {
  for (const AnyLaw& law :
       {AnyLaw(PenaltyLaw{1e4, 5e3, 0.5}), AnyLaw(HertzEllipticLaw{1e5, 0.3, 0.5})}) {
    EngineSettings s = settings_of(law, 2e-4);
    s.friction = 0.5;
    const auto engine = make_engine(s);
    add_gas(*engine, 3, 1.7, 0.5, 1.5, 1);
    const auto sums = [&] {
      Vector3d momentum = Vector3d::Zero(), turning = Vector3d::Zero();
      for (const Grain& g : engine->snapshot().grains) {
        const auto& q = g.orientation;
        const RotationOf<3> turn(q[0], q[1], q[2], q[3]);
        momentum += g.mass * g.velocity;
        turning += g.mass * g.position.cross(g.velocity) +
                   turn * g.moments.cwiseProduct(turn.conjugate() * g.angular_velocity);
      }
      return std::pair(momentum, turning);
    };
    const auto [momentum, turning] = sums();
    engine->step(1);
    EXPECT_GT(engine->measure().contacts, 30);
    engine->step(2000);
    const auto [after, turning_after] = sums();
    EXPECT_NEAR((after - momentum).norm(), 0, 1e-10);
    EXPECT_NEAR((turning_after - turning).norm(), 0, 1e-9);
  }
}

// Bits: of threads, of a checkpoint in the middle, in a box with gravity and in a cell that shears.
TEST(SuperellipsoidEngine, SameBitsOnAnyThreadsAndAfterARestart) {
  const auto run = [](bool cell, int threads, long cut) {
    EngineSettings s = settings_of(HertzEllipticLaw{1e5, 0.3, 0.3}, 2e-4);
    s.friction = 0.4;
    s.gravity_z = cell ? 0 : -5;
    s.threads = threads;
    if (cell) {
      s.cell.periodic = {true, true, true};
      s.cell.edges = 7.4 * Eigen::Matrix3d::Identity();
      s.cell.velocity_gradient(0, 2) = 0.3;
    }
    const auto made = [&] {
      auto engine = make_engine(s);
      if (!cell) add_box(*engine, 7.4, 0.3);
      return engine;
    };
    auto engine = made();
    add_gas(*engine, 4, 1.85, 0.4, 1.6, 1);
    if (cut > 0) {
      engine->step(cut);
      const std::string checkpoint = engine->checkpoint();
      engine = made();
      engine->restore(checkpoint);
    }
    engine->step(600 - engine->steps());
    EXPECT_GT(engine->measure().contacts, 60);
    return bits::hash_of(engine->snapshot());
  };
  for (const bool cell : {false, true}) {
    const std::uint64_t one = run(cell, 1, 0);
    EXPECT_TRUE(run(cell, 3, 0) == one) << cell;
    EXPECT_TRUE(run(cell, 2, 333) == one) << cell;
  }
}

TEST(SuperellipsoidEngine, SleepsAndWakes) {
  EngineSettings s = settings_of(PenaltyLaw{1e4, 1e4, 1}, 5e-4);
  s.friction = 0.5;
  s.gravity_z = -1;
  s.sleep.on = true;
  s.sleep.quiet_time = 0.05;
  s.sleep.quiet_move = 1e-2;
  s.sleep.quiet_creep = 1e-2;
  s.sleep.quiet_force = 0.4;
  s.sleep.wake_force = 0.6;
  s.sleep.wake_speed = 5;
  const auto engine = make_engine(s);
  add_box(*engine, 5.2, 0.5);
  add_gas(*engine, 2, 2.6, 0.7, 1.3, 0.1);
  engine->set_background_damping(2);
  engine->step(60000);
  // All sleep at once now and then, though one wakes for a look in between.
  for (int k = 0; k < 100 && engine->measure().awake > 0; ++k) engine->step(50);
  EXPECT_EQ(engine->measure().awake, 0);
  const double height = engine->measure().height;
  engine->set_gravity(0, 0, 1);
  engine->step(2000);
  EXPECT_GT(engine->measure().height, height);
}

TEST(SuperellipsoidEngine, GoesOnFromASnapshot) {
  EngineSettings s = settings_of(PenaltyLaw{1e4, 5e3, 0.5}, 2e-4);
  s.friction = 0.4;
  const auto engine = make_engine(s);
  add_gas(*engine, 3, 1.8, 0.5, 1.5, 0.5);
  engine->step(500);
  const Snapshot now = engine->snapshot();
  const auto next = make_engine(s, now);
  const Snapshot again = next->snapshot();
  for (std::size_t k = 0; k < now.grains.size(); ++k) {
    EXPECT_EQ(now.grains[k].axes, again.grains[k].axes);
    EXPECT_EQ(now.grains[k].exponents, again.grains[k].exponents);
    EXPECT_NEAR(now.grains[k].volume, again.grains[k].volume, 1e-14);
  }
  next->step(1);
  engine->step(1);
  const Snapshot a = engine->snapshot(), b = next->snapshot();
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  double most = 0;
  for (const Contact& c : a.contacts) most = std::max(most, c.force.norm());
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    EXPECT_NEAR((a.contacts[k].force - b.contacts[k].force).norm(), 0, 5e-3 * most) << k;
  }
}

TEST(SuperellipsoidEngine, StepGoesByStiffnessAndMoments) {
  EngineSettings s = settings_of(PenaltyLaw{1e4, 0, 0}, 1e-4);
  const FeltMass ball = felt_mass(superellipsoid({1, 1, 1}, {1, 1}), 2);
  EXPECT_NEAR(ball.mass, 2 * 4.0 / 3 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(ball.radius, 1, 1e-12);
  // A rod feels a push at the lever r3 - r1 of its outermost normals.
  const FeltMass rod = felt_mass(superellipsoid({0.2, 0.2, 2}, {1, 1}), 2);
  const double mass = 2 * 0.08 * 4.0 / 3 * std::numbers::pi;
  EXPECT_NEAR(mass / rod.mass, 1 + 5 * 1.8 * 1.8 / (4 + 0.04), 0.1);
  EXPECT_LT(stable_time_step(s, rod.mass, rod.radius), stable_time_step(s, mass, rod.radius));
}

TEST(SuperellipsoidEngine, WhatDoesNotFitIsRefused) {
  const auto refusal = [](const auto& act) {
    try {
      act();
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EngineSettings s = settings_of(HertzLaw{}, 1e-4);
  EXPECT_EQ(refusal([&] { make_engine(s); }),
            "material.law: found \"hertz\", allowed for grains of this shape: linear, penalty, "
            "hertz_elliptic");
  s.law = PenaltyLaw{};
  s.rolling.friction = 0.1;
  s.rolling.stiffness = 1;
  EXPECT_EQ(refusal([&] { make_engine(s); }),
            "material.rolling_friction: found above 0, allowed for superellipsoids: 0 (their "
            "shapes resist rolling)");
  s.rolling = {};
  const auto engine = make_engine(s);
  Wall pipe{"pipe", {0, 0, 0}, {0, 0, 1}, 0};
  pipe.shape = "cylinder";
  pipe.radius = 3;
  EXPECT_EQ(refusal([&] { engine->add_wall(pipe); }),
            "wall pipe: shape: found \"cylinder\", allowed for superellipsoids: plane");
  NewGrain g;
  g.density = 1;
  EXPECT_THAT(refusal([&] { engine->add(g); }), HasSubstr("semi-axes: found 0, 0, 0 m"));
  g.axes = {1, 1, 1};
  g.exponents = {2, 1};
  EXPECT_THAT(refusal([&] { engine->add(g); }), HasSubstr("exponents: found 2, 1"));
  MaterialSetup m;
  m.law = "hertz_elliptic";
  m.poisson = 0.6;
  EXPECT_EQ(refusal([&] { law_of(m); }),
            "material.poisson: found 0.6, allowed: above -1, up to 0.5");
}

}  // namespace
}  // namespace grainfield::dem
