// Motion and contact laws against closed forms; conservation; the same bits on any threads.
#include "dem/engine/engine.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "dem/random/random.h"

namespace grainfield::dem {
namespace {

constexpr double kPi = std::numbers::pi;

EngineSettings linear(double gamma_n = 0, double gamma_t = 0) {
  EngineSettings s;
  s.law = LinearLaw{1e6, 3e5, gamma_n, gamma_t};
  s.time_step = 1e-6;
  s.friction = 0;
  s.gravity_y = 0;
  return s;
}

NewGrain disk(double x, double y, double r = 0.01, double vx = 0, double vy = 0, double spin = 0) {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.vx = vx;
  g.vy = vy;
  g.spin = spin;
  g.radius = r;
  g.density = 1000;
  return g;
}

Wall floor_wall(double friction = 0) { return {"floor", {0, 0, 0}, {0, 1, 0}, friction}; }

// Two disks on a floor, always in contact, oscillating in their two normal modes: closed form.
// The error after `steps` steps, in units of the amplitude.
double two_grain_error(IntegratorKind kind, int steps) {
  const double r = 0.01, m = 1000 * kPi * r * r, k = 1e4;
  const double l1 = (3 - std::sqrt(5.0)) / 2, l2 = (3 + std::sqrt(5.0)) / 2;
  const double w1 = std::sqrt(k / m * l1), w2 = std::sqrt(k / m * l2);
  const double end = 10.0 / w1;
  EngineSettings s = linear();
  s.law = LinearLaw{k, 0, 0, 0};
  s.integrator = kind;
  s.gravity_y = -9.81;
  s.time_step = end / steps;
  const auto engine = make_engine(s);
  engine->add_wall(floor_wall());
  // Rest: the floor's spring carries 2 m g, the upper contact m g.
  const double y1 = r - 2 * m * 9.81 / k, y2 = y1 + 2 * r - m * 9.81 / k;
  // x'' = -(k/m) [[2,-1],[-1,1]] x; eigenvalues (3 -+ sqrt 5)/2.
  const double amplitude = 0.3 * m * 9.81 / k;
  const double a = 0.5 * amplitude, b = -0.2 * amplitude;  // shares of the modes (1, 2 - l)
  engine->add(disk(0, y1 + a + b, r));
  engine->add(disk(0, y2 + a * (2 - l1) + b * (2 - l2), r));
  engine->step(steps);
  const double t = end;
  const double e1 = y1 + a * std::cos(w1 * t) + b * std::cos(w2 * t);
  const double e2 = y2 + a * (2 - l1) * std::cos(w1 * t) + b * (2 - l2) * std::cos(w2 * t);
  const Snapshot snap = engine->snapshot();
  return std::hypot(snap.grains[0].position.y() - e1, snap.grains[1].position.y() - e2) / amplitude;
}

void expect_order(IntegratorKind kind, int steps, double expected) {
  double previous = two_grain_error(kind, steps);
  // Three refinements by 1.5; beyond them Gear's error is down at the rounding of the overlaps
  // (1e-11).
  for (int level = 0; level < 3; ++level) {
    steps = steps * 3 / 2;
    const double error = two_grain_error(kind, steps);
    EXPECT_NEAR(std::log(previous / error) / std::log(1.5), expected, 0.2)
        << steps << " steps, error " << error;
    previous = error;
  }
}

TEST(Integrators, VerletIsOfSecondOrder) { expect_order(IntegratorKind::verlet, 200, 2); }
TEST(Integrators, GearIsOfFifthOrder) { expect_order(IntegratorKind::gear, 320, 5); }

TEST(Integrators, EnergyIsConservedWithoutDamping) {
  for (const bool area : {false, true}) {
    for (const IntegratorKind kind : {IntegratorKind::verlet, IntegratorKind::gear}) {
      EngineSettings s = linear();
      if (area) s.law = OverlapAreaLaw{1e6, 0};
      s.integrator = kind;
      const auto engine = make_engine(s);
      engine->add(disk(-0.0101, 0, 0.01, 0.3, 0.05));
      engine->add(disk(0.0101, 0.003, 0.01, -0.2, 0));
      const double before = engine->measure().kinetic_energy;
      engine->step(40000);
      EXPECT_EQ(engine->measure().contacts, 0);
      EXPECT_NEAR(engine->measure().kinetic_energy / before, 1, 1e-6);
    }
  }
}

// Linear spring and dashpot that never attracts: contact ends when the force is zero, so
// e = exp(-(b/w)(pi - atan(2 b w / (w^2 - b^2)))), b = gamma/2, w = sqrt(k/m_eff - b^2) (Schwager
// and Poeschel 2007, eq. 21, for b < k/m / sqrt 2).
TEST(LinearLaw, RestitutionIsAnalytic) {
  for (const double gamma : {10.0, 200.0, 1000.0}) {
    EngineSettings s = linear(gamma);
    s.time_step = 1e-7;
    const auto engine = make_engine(s);
    engine->add(disk(-0.01000001, 0, 0.01, 1));
    engine->add(disk(0.01000001, 0, 0.01, -1));
    engine->step(50000);
    const double m_eff = 0.5 * 1000 * kPi * 1e-4, b = gamma / 2;
    const double w = std::sqrt(1e6 / m_eff - b * b);
    const double e = std::exp(-b / w * (kPi - std::atan2(2 * b * w, w * w - b * b)));
    const Snapshot snap = engine->snapshot();
    EXPECT_EQ(engine->measure().contacts, 0);
    EXPECT_NEAR(snap.grains[1].velocity.x(), e, 2e-4) << gamma;
    EXPECT_NEAR(snap.grains[0].velocity.x() + snap.grains[1].velocity.x(), 0, 1e-12);
  }
}

TEST(OverlapAreaLaw, NeverAttractsAndLosesEnergyWithDamping) {
  for (const double gamma : {0.1, 0.75, 3.0}) {
    EngineSettings s = linear();
    s.law = OverlapAreaLaw{1e6, gamma};
    const auto engine = make_engine(s);
    engine->add(disk(-0.01001, 0, 0.01, 0.5));
    engine->add(disk(0.01001, 0, 0.01, -0.5));
    double last = 1e9;
    for (int k = 0; k < 400; ++k) {
      engine->step(50);
      const Snapshot snap = engine->snapshot();
      for (const Contact& c : snap.contacts) EXPECT_GE(c.normal_force, -1e-12);
      const Diagnostics d = engine->measure();
      const double energy = d.kinetic_energy + d.elastic_energy;
      EXPECT_LE(energy, last * (1 + 2e-3));  // the stored energy is exact to O(depth/r)
      last = energy;
    }
    EXPECT_GT(engine->snapshot().grains[1].velocity.x(), 0);
    EXPECT_LT(engine->snapshot().grains[1].velocity.x(), 0.5);
  }
}

// A block on an incline: sticks below tan theta = mu; above, it slides with g (sin - mu cos).
TEST(Friction, BlockOnAnInclineSticksAndSlides) {
  const double mu = 0.4;
  for (const bool area : {false, true}) {
    for (const double tangent : {0.3, 0.39, 0.41, 0.6}) {
      const double theta = std::atan(tangent);
      EngineSettings s = linear(2000, 2000);
      if (area) s.law = OverlapAreaLaw{1e6, 0.75};
      s.gravity_x = 9.81 * std::sin(theta);
      s.gravity_y = -9.81 * std::cos(theta);
      s.time_step = 1e-5;
      const auto engine = make_engine(s);
      engine->add_wall(floor_wall(mu));
      NewGrain block = disk(0, 0.01);
      block.rotates = false;
      engine->add(block);
      engine->step(20000);
      const double v0 = engine->snapshot().grains[0].velocity.x();
      engine->step(20000);
      const double a = (engine->snapshot().grains[0].velocity.x() - v0) / 0.2;
      const double expected = tangent < mu ? 0 : 9.81 * (std::sin(theta) - mu * std::cos(theta));
      EXPECT_NEAR(a, expected, 1e-6 * 9.81) << tangent;
      EXPECT_EQ(engine->measure().sliding, tangent < mu ? 0 : 1);
      if (tangent < mu) {
        EXPECT_NEAR(engine->snapshot().contacts.at(0).tangential_force /
                        engine->snapshot().contacts.at(0).normal_force,
                    -tangent, 1e-5);
      }
    }
  }
}

// A disk rolls without slip up to tan theta = 3 mu, at (2/3) g sin theta; beyond, it also slides.
TEST(Friction, DiskOnAnInclineRolls) {
  for (const double tangent : {0.5, 1.1, 1.5}) {
    const double mu = 0.4, theta = std::atan(tangent);
    EngineSettings s = linear(2000, 2000);
    s.gravity_x = 9.81 * std::sin(theta);
    s.gravity_y = -9.81 * std::cos(theta);
    s.time_step = 1e-5;
    const auto engine = make_engine(s);
    engine->add_wall(floor_wall(mu));
    engine->add(disk(0, 0.01));
    engine->step(20000);
    const double v0 = engine->snapshot().grains[0].velocity.x();
    engine->step(20000);
    const double a = (engine->snapshot().grains[0].velocity.x() - v0) / 0.2;
    const double expected = tangent < 3 * mu ? 2.0 / 3 * 9.81 * std::sin(theta)
                                             : 9.81 * (std::sin(theta) - mu * std::cos(theta));
    // The lever is the distance to the contact point, shorter than r by the overlap (1e-5 r).
    EXPECT_NEAR(a, expected, 1e-3 * expected) << tangent;
  }
}

// A heap of random disks falling into a box; returns its state as bits.
std::unique_ptr<Engine> falling(int threads, IntegratorKind kind, bool mirrored = false,
                                double density = 1000) {
  EngineSettings s;
  s.law = OverlapAreaLaw{1e6, 0.75};
  s.friction = 0.5;
  s.time_step = kind == IntegratorKind::gear ? 5e-6 : 2e-5;
  s.integrator = kind;
  s.threads = threads;
  auto engine = make_engine(s);
  engine->add_wall(floor_wall(0.5));
  engine->add_wall({"left", {-0.1, 0, 0}, {1, 0, 0}, 0.2});
  engine->add_wall({"right", {0.1, 0, 0}, {-1, 0, 0}, 0.2});
  Random random(7);
  for (int row = 0; row < 12; ++row) {
    for (int k = 0; k < 8; ++k) {
      NewGrain g = disk(-0.08 + 0.0225 * k + random.uniform(-0.001, 0.001), 0.02 + 0.025 * row,
                        random.uniform(0.004, 0.01), random.uniform(-0.5, 0.5), -0.5);
      g.density = density;
      g.fixed = row == 0 && k % 3 == 0;
      if (mirrored) {
        g.x = -g.x;
        g.vx = -g.vx;
      }
      engine->add(g);
    }
  }
  return engine;
}

TEST(Engine, SameBitsOnAnyNumberOfThreads) {
  for (const IntegratorKind kind : {IntegratorKind::verlet, IntegratorKind::gear}) {
    const auto one = falling(1, kind);
    one->step(3000);
    const std::string expected = one->checkpoint();
    for (const int threads : {2, 3, 4, 8}) {
      const auto many = falling(threads, kind);
      many->step(3000);
      EXPECT_TRUE(many->checkpoint() == expected) << threads << " threads";
    }
  }
}

TEST(Engine, SameBitsHoweverTheStepsAreCut) {
  const auto whole = falling(1, IntegratorKind::verlet);
  whole->step(3000);
  const auto cut = falling(2, IntegratorKind::verlet);
  Random random(3);
  for (long left = 3000; left > 0;) {
    const long n = std::min<long>(left, 1 + static_cast<long>(random.uniform(0, 400)));
    cut->step(n);
    left -= n;
  }
  EXPECT_TRUE(whole->checkpoint() == cut->checkpoint());
}

TEST(Engine, RestartsToTheSameBits) {
  for (const IntegratorKind kind : {IntegratorKind::verlet, IntegratorKind::gear}) {
    const auto whole = falling(1, kind);
    whole->step(1237);
    const std::string middle = whole->checkpoint();
    whole->step(1763);
    EngineSettings s;
    s.law = OverlapAreaLaw{1e6, 0.75};
    s.friction = 0.5;
    s.time_step = kind == IntegratorKind::gear ? 5e-6 : 2e-5;
    s.integrator = kind;
    const auto resumed = make_engine(s);
    resumed->add_wall(floor_wall(0.5));
    resumed->add_wall({"left", {-0.1, 0, 0}, {1, 0, 0}, 0.2});
    resumed->add_wall({"right", {0.1, 0, 0}, {-1, 0, 0}, 0.2});
    resumed->restore(middle);
    resumed->step(1763);
    EXPECT_TRUE(whole->checkpoint() == resumed->checkpoint());
    EXPECT_THROW(resumed->restore(middle.substr(0, middle.size() - 9)), std::invalid_argument);
    EXPECT_THROW(resumed->restore(middle + "x"), std::invalid_argument);
  }
}

TEST(Engine, ForcesSumToZeroAndCarryTheWeight) {
  const auto engine = falling(1, IntegratorKind::verlet);
  engine->set_background_damping(100);
  engine->step(150000);
  const Diagnostics d = engine->measure();
  EXPECT_LT(d.unbalanced_force_ratio, 1e-6);
  const Snapshot s = engine->snapshot();
  Vec3 outside(0, 0, 0);
  double weight = 0;
  for (const Contact& c : s.contacts) {
    if (c.j < 0) {
      outside += c.force;
    } else if (s.grains[c.i].fixed) {
      outside -= c.force;
    } else if (s.grains[c.j].fixed) {
      outside += c.force;
    }
    // Force and tangent are consistent with the normal.
    const Vec3 tangent(-c.normal.y(), c.normal.x(), 0);
    EXPECT_LT((c.force + c.normal_force * c.normal - c.tangential_force * tangent).norm(), 1e-12);
    EXPECT_LE(std::fabs(c.tangential_force), c.friction * c.normal_force * (1 + 1e-9) + 1e-12);
  }
  for (const Grain& g : s.grains) weight += g.fixed ? 0 : g.mass * 9.81;
  EXPECT_NEAR(outside.y() / weight, 1, 1e-5);
  EXPECT_NEAR(outside.x() / weight, 0, 1e-5);
}

// A mirrored heap stays the mirror image until rounding, amplified by collisions, shows.
TEST(Engine, MirroredHeapMovesAlike) {
  const auto a = falling(1, IntegratorKind::verlet), b = falling(1, IntegratorKind::verlet, true);
  a->step(1500);
  b->step(1500);
  const Snapshot s = a->snapshot(), t = b->snapshot();
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    EXPECT_NEAR(s.grains[k].position.x(), -t.grains[k].position.x(), 1e-9);
    EXPECT_NEAR(s.grains[k].position.y(), t.grains[k].position.y(), 1e-9);
    EXPECT_NEAR(s.grains[k].angle, -t.grains[k].angle, 1e-6);
  }
}

TEST(Engine, MomentumIsConservedInACloud) {
  EngineSettings s = linear(300, 200);
  s.friction = 0.6;
  s.time_step = 1e-5;
  const auto engine = make_engine(s);
  Random random(11);
  for (int i = 0; i < 15; ++i) {
    for (int j = 0; j < 15; ++j) {
      engine->add(disk(0.021 * i, 0.021 * j, random.uniform(0.003, 0.0104), random.uniform(-1, 1),
                       random.uniform(-1, 1), random.uniform(-50, 50)));
    }
  }
  const auto momentum = [](const Snapshot& snap) {
    Vec3 p(0, 0, 0);
    double l = 0;
    for (const Grain& g : snap.grains) {
      p += g.mass * g.velocity;
      l += g.mass * (g.position.x() * g.velocity.y() - g.position.y() * g.velocity.x()) +
           g.inertia * g.spin;
    }
    return Vec3(p.x(), p.y(), l);
  };
  const Vec3 before = momentum(engine->snapshot());
  const double kinetic = engine->measure().kinetic_energy;
  engine->step(5000);
  EXPECT_LT(engine->measure().kinetic_energy, 0.9 * kinetic);  // grains have collided
  EXPECT_LT((momentum(engine->snapshot()) - before).norm(), 1e-9);
}

TEST(Engine, DivergenceIsReported) {
  EngineSettings s = linear();
  s.time_step = 1e-2;  // far above the stable limit
  s.gravity_y = -9.81;
  const auto engine = make_engine(s);
  engine->add_wall(floor_wall());
  engine->add(disk(0, 0.008));
  engine->add(disk(0.001, 0.026));
  try {
    engine->step(100000);
    FAIL() << "no exception";
  } catch (const ComputationFailed& failure) {
    EXPECT_THAT(failure.what(), testing::HasSubstr("diverged at t ="));
    EXPECT_THAT(failure.what(), testing::HasSubstr("grain"));
    EXPECT_THAT(failure.what(), testing::HasSubstr("lower motion.time_step"));
  }
}

TEST(Engine, AppliedForceRampsSmoothly) {
  EngineSettings s = linear();
  s.time_step = 1e-5;
  const auto engine = make_engine(s);
  const auto id = engine->add(disk(0, 0));
  AppliedForce f;
  f.id = id;
  f.fx = 2;
  f.ramp = 0.1;
  engine->apply(f);
  engine->step(20000);
  // Impulse: F (T - ramp/2) with the symmetric ramp.
  const double mass = 1000 * kPi * 1e-4;
  EXPECT_NEAR(engine->snapshot().grains[0].velocity.x(), 2 * (0.2 - 0.05) / mass, 1e-3);
  EXPECT_EQ(engine->snapshot().loaded_grain, id);
}

TEST(Engine, StableTimeStepKnowsTheDashpots) {
  EngineSettings s = linear();
  EXPECT_NEAR(stable_time_step(s, 0.1), 0.1 * kPi * std::sqrt(0.1 / 1e6), 1e-12);
  s.law = OverlapAreaLaw{1e7, 0.75};
  s.integrator = IntegratorKind::verlet;
  const double verlet = stable_time_step(s, 0.3);
  s.integrator = IntegratorKind::gear;
  EXPECT_LT(stable_time_step(s, 0.3), 0.2 * verlet);
}

TEST(Engine, RefusesBadSettings) {
  EngineSettings s;
  s.time_step = 0;
  EXPECT_THROW(make_engine(s), std::invalid_argument);
  s.time_step = 1e-5;
  s.friction = -1;
  EXPECT_THROW(make_engine(s), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::dem
