// Samples of superellipsoids: drawn, compressed in a cell and between walls, refused.
#include <gmock/gmock.h>

#include "coupling/studies/sample/simulation/checks.h"
#include "coupling/studies/sample/simulation/sample.h"
#include "coupling/studies/sample/simulation/state.h"
#include "dem/shapes/superellipsoid.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

SampleSetup setup_of(const std::string& law, const std::string& boundary) {
  SampleSetup s;
  s.plan.dim = 3;
  s.plan.shape = "superellipsoid";
  s.plan.grains = 100;
  s.plan.radius = 1;
  s.plan.start_fraction = 0.1;
  s.plan.boundary = boundary;
  s.plan.pressure = 20;
  s.plan.compression_rate = 1;
  s.plan.deformation = "uniaxial";
  s.plan.strain = 0.02;
  s.plan.strain_rate = 0.1;
  s.plan.records = 2;
  s.material.law = law;
  s.material.density = 1;
  s.material.normal_stiffness = s.material.tangential_stiffness = 1e4;
  s.material.young = 1e5;
  s.material.damping = 0.5;
  s.rest.background_damping = 2;
  s.rest.unbalanced_force_ratio = 0.02;
  s.rest.kinetic_to_elastic_energy = 1e-3;
  return s;
}

TEST(SampleOfSuperellipsoids, IsDrawnFromItsRanges) {
  SamplePlan plan = setup_of("penalty", "periodic").plan;
  plan.grains = 2000;
  Random random(4);
  const auto grains = draw_sample(plan, random);
  double volume = 0, least = 9, most = 0;
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  for (const ShapedGrain& g : grains) {
    volume += g.area;
    for (const double r : g.axes) {
      least = std::min(least, r);
      most = std::max(most, r);
    }
    for (const double e : g.exponents) EXPECT_TRUE(e >= 0.7 && e < 1.3);
    const auto& q = g.orientation;
    const Eigen::Vector3d axis = RotationOf<3>(q[0], q[1], q[2], q[3]) * Eigen::Vector3d::UnitX();
    turned += axis * axis.transpose() / 2000;
    EXPECT_LE(g.radius, sample_radii(plan).most);
  }
  EXPECT_GE(least, 0.5);
  EXPECT_LT(most, 1.5);
  EXPECT_LT(least, 0.51);
  EXPECT_GT(most, 1.49);
  EXPECT_NEAR(volume / mean_volume(plan), 1, 0.04);
  // No direction is preferred: a third each, within four standard errors.
  EXPECT_NEAR((turned - Eigen::Matrix3d::Identity() / 3).norm(), 0, 0.04);
}

// Semi-axes times a size: the mean volume goes by the mean of its cube.
TEST(SampleOfSuperellipsoids, ComeInSizes) {
  SamplePlan plan = setup_of("penalty", "periodic").plan;
  plan.grains = 4000;
  plan.axes_times = "sizes";
  plan.polydispersity = 0.5;
  plan.size_ratio = 3;
  for (const char* sizes : {"mono", "uniform", "bidisperse"}) {
    plan.sizes = sizes;
    Random random(4);
    double volume = 0, least = 9, most = 0;
    for (const ShapedGrain& g : draw_sample(plan, random)) {
      volume += g.area;
      for (const double r : g.axes) {
        least = std::min(least, r);
        most = std::max(most, r);
      }
      EXPECT_LE(g.radius, sample_radii(plan).most);
    }
    // Four standard errors of volumes whose spread is about their mean.
    EXPECT_NEAR(volume / mean_volume(plan), 1, 0.07) << sizes;
    const double smallest = plan.sizes == "mono" ? 1 : plan.sizes == "uniform" ? 0.5 : 1.0 / 3;
    const double largest = plan.sizes == "uniform" ? 1.5 : 1;
    EXPECT_GE(least, 0.5 * smallest);
    EXPECT_LT(least, 0.6 * smallest);
    EXPECT_LE(most, 1.5 * largest);
    EXPECT_GT(most, 1.35 * largest);
    EXPECT_LE(sample_radii(plan).least, 0.5 * smallest);
  }
}

TEST(SampleOfSuperellipsoids, RestsAtItsPressureInACellAndBetweenWalls) {
  for (const auto& [law, boundary] :
       {std::pair("penalty", "periodic"), {"hertz_elliptic", "walls"}}) {
    const SampleSetup setup = setup_of(law, boundary);
    const auto run = make_sample_run(setup, 3, 1);
    while (!run->done()) run->advance(100000);
    const RunResult result = run->result();
    ASSERT_EQ(result.snapshots.size(), 3U);
    const SampleState first = sample_state(result.snapshots[0].second);
    const SampleState last = sample_state(result.snapshots[2].second);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(-first.stress(a, a), 20, 2) << law << " " << a;
    EXPECT_GT(first.solid_fraction, 0.5);
    EXPECT_LT(last.stress(2, 2), first.stress(2, 2));
    EXPECT_NEAR(last.volume / first.volume, 0.98, 1e-3);
    EXPECT_FALSE(result.snapshots[0].second.grains[7].axes.isZero(0));
  }
}

// Dropped grains between servos on all sides, which must feel the grains alone, not what the walls
// had felt in the drop.
TEST(SampleOfSuperellipsoids, RestsAtItsPressureAfterADrop) {
  SampleSetup setup = setup_of("penalty", "walls");
  setup.plan.filling = "dropped";
  setup.plan.drop_gravity = 5;
  setup.plan.drop_damping = 1;
  setup.rest.max_time = 60;
  const auto run = make_sample_run(setup, 3, 1);
  while (!run->done()) run->advance(100000);
  const RunResult result = run->result();
  const SampleState first = sample_state(result.snapshots[0].second);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(first.moved_pressure[a], 20, 0.1) << a;
  EXPECT_GT(result.figures.at("sample.gap_spheres"), 0);
}

// Dense superellipsoids of little friction answer a servo on three edges by more than the spheres
// that it is made for: with their stiffness alone it swings for ever.
TEST(SampleOfSuperellipsoids, OfLittleFrictionRestInACell) {
  SampleSetup setup = setup_of("hertz_elliptic", "periodic");
  setup.plan.radius = 1e-3;
  setup.plan.pressure = 1e4;
  setup.plan.compression_rate = 30;
  setup.plan.strain_rate = 30;
  setup.material.density = 2500;
  setup.material.young = 3e7;
  setup.material.poisson = 0.22;
  setup.material.damping = 0.3;
  setup.material.friction = 0.05;
  setup.rest.background_damping = 500;
  setup.rest.unbalanced_force_ratio = 1e-2;
  setup.rest.max_time = 0.05;
  const auto run = make_sample_run(setup, 3, 1);
  while (!run->done()) run->advance(100000);
  const SampleState first = sample_state(run->result().snapshots[0].second);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(-first.stress(a, a), 1e4, 50) << a;
  EXPECT_GT(first.solid_fraction, 0.66);
}

TEST(SampleOfSuperellipsoids, WhatDoesNotFitIsRefused) {
  const auto refusal = [](const auto& change) {
    SampleSetup s = setup_of("penalty", "periodic");
    change(s);
    try {
      SampleGroundwork::check(s);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal([](SampleSetup&) {}), "accepted");
  EXPECT_EQ(refusal([](SampleSetup& s) { s.material.law = "hertz"; }),
            "material.law: found \"hertz\", allowed for superellipsoids: linear, penalty, "
            "hertz_elliptic");
  EXPECT_EQ(refusal([](SampleSetup& s) { s.plan.axis_max = 0.4; }),
            "sample.axis_max: found 0.4, allowed: at least sample.axis_min = 0.5");
  EXPECT_EQ(refusal([](SampleSetup& s) { s.plan.exponent_max = 0.5; }),
            "sample.exponent_max: found 0.5, allowed: at least sample.exponent_min = 0.7");
  EXPECT_EQ(refusal([](SampleSetup& s) { s.plan.exponent_max = 2.5; }),
            "a superellipsoid's exponents: found 2.5, 2.5, allowed: 0.1 to 1.9");
  EXPECT_THAT(refusal([](SampleSetup& s) { s.plan.start_fraction = 0.3; }),
              HasSubstr("sample.start_fraction: found 0.3, allowed with superellipsoids of these "
                        "axes: up to 0.1"));
  EXPECT_THAT(refusal([](SampleSetup& s) {
                s.material.rolling_friction = 0.1;
                s.material.rolling_stiffness = 1;
              }),
              HasSubstr("allowed for superellipsoids: 0"));
  EXPECT_EQ(refusal([](SampleSetup& s) {
              s.material.law = "hertz_elliptic";
              s.material.poisson = -1;
            }),
            "material.poisson: found -1, allowed: above -1, up to 0.5");
}

}  // namespace
}  // namespace grainfield::dem
