// Friction's spring of Hertz' law: Mindlin's stiffness, and what the two memories do to energy.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "dem/laws/hertz.h"
#include "dem/laws/registry.h"
#include "dem/random/random.h"
#include "dem/space/space3.h"
#include "tests/dem/cell_scene.h"

namespace grainfield::dem {
namespace {

using Eigen::Vector3d;

constexpr double kYoung = 7e7, kPoisson = 0.25, kRadius = 0.01;

HertzLaw law_of(bool displacement) {
  HertzLaw law{kYoung, kPoisson, 0};
  law.displacement = displacement;
  return law;
}
Overlap3 overlap_of(double depth) {
  Overlap3 o;
  o.normal = Vector3d::UnitZ();
  o.depth = depth;
  o.radius = 0.5 * kRadius;  // two equal spheres
  return o;
}

/// Moves i against j along a path of depth and slip, and sums the contact's work on the bodies.
class Path {
 public:
  Path(const HertzLaw& law, double mu, double depth) : law_(law), mu_(mu), depth_(depth) {
    motion_.inverse_mass = 2;
  }
  void move(double to_depth, const Vector3d& by, int steps) {
    const double from = depth_;
    for (int k = 0; k < steps; ++k) {
      depth_ = from + (to_depth - from) * (k + 1) / steps;
      if (depth_ <= 0) {
        memory_ = {};
        continue;
      }
      // The law's step: the spring answers the new depth, then the slip; the force's mean.
      const Vector3d spring = memory_.spring;
      motion_.slip = by / steps;
      const LawForce<3> f = law_(overlap_of(depth_), motion_, mu_, 1, memory_);
      work_ += 0.5 * (spring + f.tangential).dot(by / steps);
      stored_ = std::max(stored_, 0.5 * memory_.spring.squaredNorm() / stiffness(depth_));
    }
  }
  double stiffness(double depth) const {
    return 8 * law_.effective_shear() * std::sqrt(0.5 * kRadius * depth);
  }
  const Vector3d& spring() const { return memory_.spring; }
  double work() const { return work_; }      ///< of friction on the bodies, J
  double stored() const { return stored_; }  ///< largest, in its spring, J
  double held() const { return 0.5 * memory_.spring.squaredNorm() / stiffness(depth_); }

 private:
  HertzLaw law_;
  double mu_, depth_;
  ContactMotion<3> motion_;
  HertzMemory<3> memory_;
  double work_ = 0, stored_ = 0;
};

// Spheres on a lattice touch at a depth that rounds to 0: what the spring held is gone, and a
// number.
TEST(HertzStiffening, OfADepthOfZeroIsWhatTheSpringHeld) {
  for (const bool displacement : {false, true}) {
    const HertzLaw law = law_of(displacement);
    HertzMemory<3> before;
    before.contact_radius = std::sqrt(0.5 * kRadius * 1e-6);
    before.spring = Vector3d(0.1, 0, 0);
    const double held = law.energy(overlap_of(1e-6), before).tangential;
    EXPECT_GT(held, 0);
    EXPECT_DOUBLE_EQ(law.stiffening(overlap_of(0), before), -held);
    before.spring.setZero();
    EXPECT_EQ(law.stiffening(overlap_of(0), before), 0);
  }
}

TEST(Mindlin, StiffnessOfEqualSpheres) {
  for (const bool displacement : {false, true}) {
    for (const double depth : {1e-6, 1e-5, 1e-4}) {
      Path path(law_of(displacement), 1e9, depth);
      path.move(depth, 1e-7 * Vector3d::UnitX(), 10);
      const double a = std::sqrt(0.5 * kRadius * depth);
      const double wanted = 2 * a * kYoung / ((2 - kPoisson) * (1 + kPoisson));
      EXPECT_NEAR(-path.spring().x() / 1e-7, wanted, 1e-12 * wanted);
    }
  }
}

TEST(Mindlin, AClosedLoopAtConstantNormalForceMakesNoEnergy) {
  for (const bool displacement : {false, true}) {
    for (const double mu : {1e9, 0.3}) {
      const double depth = 1e-5, reach = 1e-5;
      Path path(law_of(displacement), mu, depth);
      const int steps = 4000;
      double first = 0;
      for (int round = 0; round < 2; ++round) {
        first = path.work() + path.held();
        for (int k = 0; k < steps; ++k) {
          const auto at = [&](int n) {
            const double t = 2 * std::numbers::pi * n / steps;
            return Vector3d(reach * std::sin(t), 0.4 * reach * (1 - std::cos(t)), 0);
          };
          path.move(depth, at(k + 1) - at(k), 1);
        }
      }
      const double gained = path.work() + path.held() - first;
      if (mu > 1) {
        EXPECT_NEAR(gained, 0, 1e-9 * path.stored()) << displacement;
      } else {
        EXPECT_LT(gained, -0.1 * path.stored()) << displacement;  // it slides
      }
    }
  }
}

// Loops that begin and end apart: approach, shear, press or ease, shear back, part. Without
// sliding, so that all work of friction is the memory's.
TEST(Mindlin, LoopsOfLoadingWithDisplacementMakeEnergyWithForceNone) {
  double most[2] = {-1e300, -1e300}, mean[2] = {0, 0};
  const int loops = 1000;
  for (const bool displacement : {false, true}) {
    Random random(3);
    for (int n = 0; n < loops; ++n) {
      Path path(law_of(displacement), 1e9, 0);
      Vector3d slipped = Vector3d::Zero();
      const auto depth = [&] { return random.uniform(1e-6, 1e-4); };
      path.move(depth(), Vector3d::Zero(), 1);
      double largest = 0;
      for (int leg = 0; leg < 6; ++leg) {
        const Vector3d by(random.uniform(-1, 1) * 1e-5, random.uniform(-1, 1) * 1e-5, 0);
        path.move(depth(), by, 400);
        slipped += by;
      }
      path.move(depth(), -slipped, 400);
      largest = path.stored();
      path.move(0, Vector3d::Zero(), 400);
      most[displacement] = std::max(most[displacement], path.work() / largest);
      mean[displacement] += path.work() / largest / loops;
    }
  }
  std::printf(
      "work of friction over the largest energy in its spring, 1000 loops: force %.2g at most, "
      "%.2g in the mean; displacement %.2g, %.2g\n",
      most[0], mean[0], most[1], mean[1]);
  EXPECT_LT(most[0], 0);
  EXPECT_GT(most[1], 0.5);
}

// In closed form: sheared by s at the depth d, pressed to D, sheared back.
TEST(Mindlin, WhatPressingAShearedContactMakes) {
  const double d = 1e-5, deep = 4e-5, s = 1e-6;
  Path force(law_of(false), 1e9, d), displacement(law_of(true), 1e9, d);
  for (Path* path : {&force, &displacement}) {
    path->move(d, s * Vector3d::UnitX(), 1000);
    path->move(deep, Vector3d::Zero(), 1000);
    path->move(deep, -s * Vector3d::UnitX(), 1000);
  }
  const double k = force.stiffness(d), pressed = force.stiffness(deep);
  const double made = 0.5 * (pressed - k) * s * s;
  EXPECT_NEAR(displacement.work(), made, 2e-3 * made);
  EXPECT_NEAR(displacement.held(), 0, 1e-12 * made);
  EXPECT_NEAR(force.work(), -made, 2e-3 * made);  // lost or still held
}

TEST(Hertz, ViscoelasticDashpotsGoByTheContactsRadius) {
  HertzLaw law{kYoung, kPoisson, 0.7};
  law.viscoelastic = true;
  law.normal_damping = 3e5;
  law.tangential_damping = 1e5;
  const Overlap3 o = overlap_of(2e-5);
  ContactMotion<3> m;
  m.inverse_mass = 4;
  m.approach = 0.1;
  m.slip = Vector3d(0, 0.02, 0);
  HertzMemory<3> memory;
  const LawForce<3> f = law(o, m, 1e9, 1e-9, memory);
  const double a = std::sqrt(o.radius * o.depth), mass = 0.25;
  const double elastic = 4.0 / 3 * kYoung / (2 * (1 - kPoisson * kPoisson)) * a * o.depth;
  EXPECT_NEAR(f.normal, elastic + 3e5 * a * mass * 0.1, 1e-12 * f.normal);
  EXPECT_NEAR(f.tangential.y(), -(1e5 * a * mass + 1e-9 * 8 * law.effective_shear() * a) * 0.02,
              1e-12 * f.tangential.norm());
  // Faster dashpots shorten the step.
  EXPECT_NEAR(law.viscous_rate(1, kRadius), 0.1 * kRadius * 20 * 1e5, 1e-9 * 2e4);
}

// Spheres of a close packing that all spin alike: the fastest mode that the step's bound counts.
TEST(Hertz, SpheresThatSpinAlikeSlowAsFastAsTheBoundSays) {
  for (const bool viscoelastic : {false, true}) {
    HertzLaw law{kYoung, kPoisson, 0.4};
    law.viscoelastic = viscoelastic;
    law.normal_damping = law.tangential_damping = 1e4;
    Eigen::Matrix3d edges;
    edges << 0, 1, 1, 1, 0, 1, 1, 1, 0;
    edges *= 3 * kRadius * (2 - HertzLaw::kMostDepth) / std::numbers::sqrt2;
    EngineSettings s = cells::settings_of(ShapeKind::sphere, cells::cell_of(3, {0, 0, 0}, edges));
    s.law = law;
    s.friction = 1e9;
    NewGrain g;
    g.radius = kRadius;
    g.density = 2500;
    g.spin = 1;
    const double mass = 4.0 / 3 * std::numbers::pi * std::pow(kRadius, 3) * g.density;
    const double bound = law.viscous_rate(mass, kRadius);
    s.time_step = 1e-6 / bound;
    const auto engine = make_engine(s);
    for (int k = 0; k < 27; ++k) {
      const Vec3 at = edges * Vec3(k % 3, k / 3 % 3, k / 9) / 3;
      g.x = at.x();
      g.y = at.y();
      g.z = at.z();
      engine->add(g);
    }
    engine->step(1);
    const Snapshot now = engine->snapshot();
    EXPECT_EQ(now.contacts.size(), 6U * 27);
    for (const Grain& grain : now.grains) {
      const double rate = (g.spin - grain.spin) / s.time_step;
      EXPECT_LT(rate, bound) << viscoelastic;
      EXPECT_GT(rate, 0.95 * bound) << viscoelastic;
    }
  }
}

TEST(Hertz, MaterialNamesItsModels) {
  MaterialSetup m;
  m.law = "hertz";
  const HertzLaw plain = std::get<HertzLaw>(grainfield::dem::law_of(m));
  EXPECT_FALSE(plain.displacement || plain.viscoelastic);
  m.tangential_memory = "displacement";
  m.damping_model = "viscoelastic";
  m.normal_damping = 12;
  const HertzLaw other = std::get<HertzLaw>(grainfield::dem::law_of(m));
  EXPECT_TRUE(other.displacement && other.viscoelastic);
  EXPECT_EQ(other.normal_damping, 12);
  m.tangential_memory = "forse";
  try {
    grainfield::dem::law_of(m);
    ADD_FAILURE();
  } catch (const std::invalid_argument& e) {
    EXPECT_EQ(std::string(e.what()),
              "material.tangential_memory: found \"forse\", allowed: force, displacement; did you "
              "mean \"force\"?");
  }
}

}  // namespace
}  // namespace grainfield::dem
