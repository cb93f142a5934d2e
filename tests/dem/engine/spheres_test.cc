// Three dimensions: free turning, spheres on an incline, Hertz' impact, conservation, the same
// bits.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "dem/space/kinematics3.h"
#include "tests/dem/bits_scene.h"
#include "tests/dem/top_scene.h"

namespace grainfield::dem {
namespace {

using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;

// Error of the spin in the body frame at t = 4.
double top_error(int steps) {
  const top::Ended end = top::turned<VerletIntegrator<3>>(4, steps);
  // The angular momentum stays where it was.
  EXPECT_LT((end.momentum - top::kMoments.cwiseProduct(top::kStart)).norm(), 1e-11);
  EXPECT_LT(end.unit_error, 1e-14);
  return (end.spin - top::exact_spin(4)).norm();
}

TEST(Spheres, AFreeTopTurnsAsEulerSays) {
  double previous = top_error(100);
  for (const int steps : {200, 400, 800}) {
    const double error = top_error(steps);
    EXPECT_NEAR(std::log2(previous / error), 2, 0.2) << steps;
    previous = error;
  }
  EXPECT_LT(previous, 1e-4);
}

// In a plane, the kinematics of three dimensions is that of two.
TEST(Spheres, KinematicsInAPlaneIsTwoDimensional) {
  Random random(4);
  const auto number = [&] { return random.uniform(-1, 1); };
  for (int trial = 0; trial < 100; ++trial) {
    Body<2> a, b;
    a.velocity = {number(), number()};
    b.velocity = {number(), number()};
    a.spin = number();
    b.spin = number();
    Overlap o;
    const double angle = 3 * number();
    o.nx = std::cos(angle);
    o.ny = std::sin(angle);
    o.lever_i = 1 + number();
    o.lever_j = 1 + number();
    o.shift_i = number();
    o.shift_j = number();
    Body<3> a3, b3;
    a3.velocity = to_three(a.velocity);
    b3.velocity = to_three(b.velocity);
    a3.spin = {0, 0, a.spin};
    b3.spin = {0, 0, b.spin};
    Overlap3 o3;
    const Vector3d n(o.nx, o.ny, 0), t(-o.ny, o.nx, 0);
    o3.normal = n;
    o3.arm_i = o.lever_i * n + o.shift_i * t;
    o3.arm_j = -o.lever_j * n + o.shift_j * t;
    const ContactMotion<2> m = motion_at<false>(a, b, o);
    const ContactMotion<3> m3 = motion_at<false>(a3, b3, o3);
    EXPECT_NEAR(m.approach, m3.approach, 1e-14);
    EXPECT_NEAR((m.slip * t - m3.slip).norm(), 0, 1e-14);
    const double push = 1 + number(), drag = number();
    const ContactForce<2> f = forces_at<false>(o, push, drag);
    const ContactForce<3> f3 = forces_at<false>(o3, push, Vector3d(drag * t));
    EXPECT_NEAR((to_three(f.force) - f3.force).norm(), 0, 1e-14);
    EXPECT_NEAR(f.torque_i, f3.torque_i.z(), 1e-14);
    EXPECT_NEAR(f.torque_j, f3.torque_j.z(), 1e-14);
  }
}

EngineSettings spheres(const AnyLaw& law, double step) {
  EngineSettings s;
  s.law = law;
  s.shape = ShapeKind::sphere;
  s.time_step = step;
  s.gravity_y = 0;
  return s;
}

NewGrain sphere(const Vector3d& at, const Vector3d& v, double radius = 0.01) {
  NewGrain g;
  g.x = at.x();
  g.y = at.y();
  g.z = at.z();
  g.vx = v.x();
  g.vy = v.y();
  g.vz = v.z();
  g.radius = radius;
  g.density = 2500;
  return g;
}

constexpr double kMass = 2500 * 4.0 / 3 * kPi * 1e-6;  // of radius 0.01

// State of a sphere after 0.1 s on a slope with the downhill direction d, from rest.
Grain on_slope(double slope, double friction, bool rotates, const Vector3d& d) {
  const double k = 1e7;  // the spring of friction is loaded within 1e-5 s
  EngineSettings s = spheres(LinearLaw{k, 2 * k / 7, 3000, 1500}, 5e-6);
  // The floor is level, gravity is not.
  const Vector3d g = 9.81 * (std::sin(slope) * d - std::cos(slope) * Vector3d::UnitZ());
  s.gravity_x = g.x();
  s.gravity_y = g.y();
  s.gravity_z = g.z();
  const auto engine = make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, friction});
  NewGrain ball = sphere({0, 0, 0.01 + kMass * g.z() / k}, {0, 0, 0});
  ball.rotates = rotates;
  engine->add(ball);
  engine->step(20000);
  return engine->snapshot().grains[0];
}

TEST(Spheres, OnAnInclineTheyStickRollOrSlide) {
  const Vector3d d = Vector3d(3, 4, 0).normalized(), axis = Vector3d::UnitZ().cross(d);
  const double mu = 0.3, t = 0.1;
  // A block sticks below tan slope = mu ...
  const double steep = 1.1 * std::atan(mu), flat = 0.9 * std::atan(mu);
  EXPECT_LT(on_slope(flat, mu, false, d).velocity.norm(), 1e-3);
  // ... and slides above.
  const double pull = 9.81 * (std::sin(steep) - mu * std::cos(steep));
  EXPECT_NEAR(on_slope(steep, mu, false, d).velocity.dot(d), pull * t, 0.01 * pull * t);
  // A sphere rolls below tan slope = 7/2 mu: the spring swings a little about rolling.
  for (const double slope : {flat, 0.9 * std::atan(3.5 * mu)}) {
    const Grain ball = on_slope(slope, mu, true, d);
    const double v = 5.0 / 7 * 9.81 * std::sin(slope) * t;
    EXPECT_NEAR((ball.velocity - v * d).norm(), 0, 0.01 * v);
    EXPECT_NEAR((ball.angular_velocity - v / 0.01 * axis).norm(), 0, 0.02 * v / 0.01);
  }
  // Above it slides, and friction turns it: 5/2 mu g cos / r.
  const double slope = 1.1 * std::atan(3.5 * mu);
  const Grain ball = on_slope(slope, mu, true, d);
  const double v = 9.81 * (std::sin(slope) - mu * std::cos(slope)) * t;
  const double turning = 2.5 * mu * 9.81 * std::cos(slope) / 0.01 * t;
  EXPECT_NEAR((ball.velocity - v * d).norm(), 0, 0.01 * v);
  EXPECT_NEAR((ball.angular_velocity - turning * axis).norm(), 0, 0.01 * turning);
}

TEST(Spheres, HertzImpactHasItsForceAndDuration) {
  const HertzLaw law{1e9, 0.25, 0};
  const double v = 1, mass = 0.5 * kMass, radius = 0.005;
  const double k = 4.0 / 3 * law.effective_young() * std::sqrt(radius);
  const double depth = std::pow(1.25 * mass * v * v / k, 0.4);  // Landau and Lifshitz, vol. 7, 9
  const double force = k * std::pow(depth, 1.5), time = 2.943 * depth / v;
  const auto engine = make_engine(spheres(law, time / 2000));
  engine->add(sphere({0, 0, 0}, {0.5 * v, 0, 0}));
  engine->add(sphere({0.02 + 1e-9, 0, 0}, {-0.5 * v, 0, 0}));
  double most = 0;
  long touching = 0;
  for (int s = 0; s < 2500; ++s) {
    engine->step(1);
    const Snapshot now = engine->snapshot();
    if (now.contacts.empty()) continue;
    ++touching;
    most = std::max(most, now.contacts[0].normal_force);
    const Diagnostics d = engine->measure();
    EXPECT_NEAR(d.kinetic_energy + d.elastic_energy, 0.5 * mass * v * v, 1e-3 * mass * v * v);
  }
  EXPECT_NEAR(most, force, 1e-3 * force);
  EXPECT_NEAR(static_cast<double>(touching) / 2000, 1, 2e-3);
  EXPECT_NEAR(engine->snapshot().grains[0].velocity.x(), -0.5 * v, 1e-5 * v);
}

std::unique_ptr<Engine> cloud(const EngineSettings& settings, int count, double ratio = 2) {
  auto engine = make_engine(settings);
  Random random(7);
  for (int k = 0; k < count; ++k) {
    NewGrain g =
        sphere({0.045 * random.uniform(), 0.045 * random.uniform(), 0.06 * random.uniform()},
               {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)},
               0.006 * std::pow(ratio, -random.uniform()));
    g.spin_x = random.uniform(-50, 50);
    g.spin_y = random.uniform(-50, 50);
    g.spin = random.uniform(-50, 50);
    engine->add(g);
  }
  return engine;
}

TEST(Spheres, MomentumAndAngularMomentumStay) {
  for (const AnyLaw& law :
       {AnyLaw(LinearLaw{1e5, 3e4, 500, 200}), AnyLaw(HertzLaw{1e8, 0.3, 0.2})}) {
    const auto engine = cloud(spheres(law, 5e-6), 60);
    const auto sums = [&] {
      Vector3d momentum = Vector3d::Zero(), turning = Vector3d::Zero();
      for (const Grain& g : engine->snapshot().grains) {
        momentum += g.mass * g.velocity;
        turning += g.mass * g.position.cross(g.velocity) + g.inertia * g.angular_velocity;
      }
      return std::pair(momentum, turning);
    };
    const auto [momentum, turning] = sums();
    double size = 0;
    for (const Grain& g : engine->snapshot().grains) size += g.mass * g.velocity.norm();
    engine->step(1);
    EXPECT_GT(engine->measure().contacts, 20);
    engine->step(4000);
    const auto [after, turning_after] = sums();
    EXPECT_NEAR((after - momentum).norm(), 0, 1e-11 * size);
    EXPECT_NEAR((turning_after - turning).norm(), 0, 1e-11 * size * 0.1);
  }
}

TEST(Spheres, EnergyStaysWithoutDampingAndFriction) {
  EngineSettings s = spheres(HertzLaw{1e8, 0.3, 0}, 1e-6);
  s.friction = 0;
  const auto engine = cloud(s, 40);
  engine->step(1);
  const auto energy = [&] {
    const Diagnostics d = engine->measure();
    return d.kinetic_energy + d.elastic_energy;
  };
  const double before = energy();
  EXPECT_GT(engine->measure().elastic_energy, 0.01 * before);
  engine->step(5000);
  EXPECT_NEAR(energy(), before, 2e-3 * before);
}

TEST(Spheres, SameBitsOnAnyThreadsAndAfterARestart) {
  const auto run = [](int threads, long cut, bool sleep, long steps = 30000) {
    EngineSettings s = spheres(HertzLaw{1e7, 0.3, 0.3}, 1e-5);
    s.gravity_z = -9.81;
    s.threads = threads;
    s.sleep.on = sleep;
    s.sleep.quiet_time = 4e-3;
    s.sleep.quiet_move = 5e-2;
    s.sleep.quiet_creep = 12.5;
    s.sleep.quiet_force = 0.4;
    s.sleep.wake_force = 0.6;
    s.sleep.wake_speed = 5;
    const auto walled = [](std::unique_ptr<Engine> engine) {
      engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.5});
      const double w = 0.05;
      engine->add_wall({"left", {-0.005, 0, 0}, {1, 0, 0}, 0.3});
      engine->add_wall({"right", {w, 0, 0}, {-1, 0, 0}, 0.3});
      engine->add_wall({"front", {0, -0.005, 0}, {0, 1, 0}, 0.3});
      engine->add_wall({"back", {0, w, 0}, {0, -1, 0}, 0.3});
      return engine;
    };
    auto engine = walled(cloud(s, 60));
    engine->set_background_damping(20);
    if (cut > 0) {
      engine->step(cut);
      const std::string checkpoint = engine->checkpoint();
      engine = walled(make_engine(s));
      engine->restore(checkpoint);
    }
    engine->step(steps - engine->steps());
    if (steps == 30000) {
      EXPECT_GT(engine->measure().contacts, 60);
      EXPECT_LT(engine->measure().awake, sleep ? 50 : 61);
    }
    return bits::hash_of(engine->snapshot());
  };
  for (const bool sleep : {false, true}) {
    const std::uint64_t one = run(1, 0, sleep);
    EXPECT_TRUE(run(3, 0, sleep) == one);
    EXPECT_TRUE(run(2, 7777, sleep) == one);
  }
  // More threads than cores take long to meet.
  EXPECT_TRUE(run(8, 0, false, 1000) == run(1, 0, false, 1000));
}

TEST(Spheres, GoOnFromASnapshot) {
  EngineSettings s = spheres(LinearLaw{1e5, 3e4, 100, 100}, 5e-6);
  const auto engine = cloud(s, 40);
  engine->step(500);
  const Snapshot now = engine->snapshot();
  const auto next = make_engine(s, now);
  next->step(1);
  engine->step(1);
  const Snapshot a = engine->snapshot(), b = next->snapshot();
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  double most = 0;
  for (const Contact& c : a.contacts) most = std::max(most, c.force.norm());
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    // The first step after a start knows no acceleration of before: to its size, not to the bit.
    EXPECT_NEAR((a.contacts[k].force - b.contacts[k].force).norm(), 0, 2e-3 * most) << k;
  }
  for (std::size_t k = 0; k < a.grains.size(); ++k) {
    EXPECT_NEAR((a.grains[k].position - b.grains[k].position).norm(), 0, 1e-8);
  }
}

TEST(Spheres, WhatDoesNotFitIsRefused) {
  const auto refusal = [](const EngineSettings& s) {
    try {
      make_engine(s);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EngineSettings s = spheres(LinearLaw{}, 1e-5);
  s.integrator = IntegratorKind::gear;
  EXPECT_EQ(refusal(s),
            "motion.integrator: found \"gear\", allowed for grains of this shape (sphere): verlet");
  s.integrator = IntegratorKind::runge_kutta;
  EXPECT_EQ(refusal(s),
            "motion.integrator: found \"runge_kutta\", allowed for grains of this shape (sphere): "
            "verlet");
  s.integrator = IntegratorKind::verlet;
  EXPECT_EQ(refusal(s), "accepted");
  s.law = OverlapAreaLaw{};
  EXPECT_EQ(refusal(s),
            "material.law: found \"overlap_area\", allowed for grains of this shape: "
            "linear, hertz, penalty, hertz_elliptic");
  s.law = HertzLaw{};
  s.shape = ShapeKind::disk;
  EXPECT_EQ(refusal(s),
            "material.law: found \"hertz\", allowed for grains of this shape: "
            "overlap_area, energy, linear, penalty");
}

}  // namespace
}  // namespace grainfield::dem
