// Setups of samples whose parts do not go together.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "coupling/studies/sample/simulation/goal.h"
#include "coupling/studies/sample/simulation/grains.h"
#include "coupling/studies/sample/simulation/sample.h"
#include "dem/shared/computation_failed.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

std::string refusal(const SampleSetup& setup) {
  return refusal_of([&] { foresee_sample(setup, {1}, 10); });
}

TEST(SampleRefusals, WhatDoesNotGoTogether) {
  SampleSetup s;
  EXPECT_EQ(refusal(s), "accepted");
  s.plan.shape = "sphere";
  EXPECT_THAT(refusal(s), HasSubstr("sample.shape"));
  s = {};
  s.plan.pressure = 0;
  EXPECT_THAT(refusal(s), HasSubstr("sample.pressure"));
  s = {};
  s.plan.grains = 4;
  EXPECT_THAT(refusal(s), HasSubstr("sample.grains"));
}

TEST(SampleRefusals, RatesAreAboveZeroAndNotTooFast) {
  for (const char* boundary : {"periodic", "walls"}) {
    for (double SamplePlan::*rate : {&SamplePlan::compression_rate, &SamplePlan::strain_rate}) {
      SampleSetup s;
      s.plan.boundary = boundary;
      s.plan.deformation = "axial";
      const std::string key =
          rate == &SamplePlan::strain_rate ? "sample.strain_rate" : "sample.compression_rate";
      EXPECT_EQ(refusal(s), "accepted");
      s.plan.*rate = 1e6;
      EXPECT_THAT(refusal(s), HasSubstr(key + ": found 1e+06 1/s"));
      for (const double value : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()}) {
        s.plan.*rate = value;
        EXPECT_THAT(refusal(s), HasSubstr(key + ": found ")) << value;
        EXPECT_THAT(refusal(s), HasSubstr(" 1/s, allowed: above 0")) << value;
      }
    }
  }
}

// What would press grains into each other is refused before it is run.
TEST(SampleRefusals, ALidThatWouldCrushItsGrains) {
  SampleSetup s;
  s.plan.boundary = "walls";
  s.plan.grains = 4000;
  s.plan.deformation = "uniaxial";
  s.plan.strain = 0.4;
  EXPECT_EQ(refusal(s), "accepted");
  s.plan.strain = 0.5;  // 0.7/0.5 = 1.4
  EXPECT_EQ(refusal(s),
            "sample.strain: found 0.5, allowed: up to 0.461; grains would be crushed, they would "
            "fill 1.4 of the box at least, where 1.3 is the most");
  s.plan.strain = 0.461;  // what it says is taken
  EXPECT_EQ(refusal(s), "accepted");
  s.plan.strain = 0.1;
  s.plan.precompression = 0.6;
  EXPECT_THAT(refusal(s), HasSubstr("sample.precompression: found 0.6, allowed: up to 0.4"));
  s = {};
  s.plan.grains = 4000;
  s.plan.compress_to = "strain";
  s.plan.compression_strain = 0.6;  // 0.3/0.16
  EXPECT_THAT(
      refusal(s),
      HasSubstr("sample.compression_strain: found 0.6, allowed: up to 0.519; grains would be "
                "crushed, they would fill 1.87 of the cell"));
  // A servo gives way, and a shear keeps the volume.
  s = {};
  s.plan.grains = 4000;
  s.plan.deformation = "axial";
  s.plan.strain = 0.8;
  EXPECT_EQ(refusal(s), "accepted");
}

TEST(SampleRefusals, WhatARunFindsOut) {
  SampleSetup s;
  const auto failure = [](const auto& call) {
    try {
      call();
    } catch (const ComputationFailed& e) {
      return std::string(e.what());
    }
    return std::string("none");
  };
  Diagnostics d;
  d.max_overlap_ratio = 0.49;
  const auto crushed = [&] { check_not_crushed(s, d, "at a strain of 0.3", "strain"); };
  EXPECT_EQ(failure(crushed), "none");
  d.max_overlap_ratio = 0.62;
  EXPECT_EQ(failure(crushed),
            "a grain is crushed at a strain of 0.3: it overlaps by 0.62 of its radius, allowed: "
            "below 0.5; lower sample.strain, or raise material.normal_stiffness");
  s.material.law = "hertz_elliptic";
  EXPECT_THAT(failure(crushed), HasSubstr("or raise material.young"));

  EXPECT_EQ(failure([&] { check_fraction_ahead(s.plan, 0.9); }), "none");  // to a pressure
  s.plan.compress_to = "solid_fraction";
  s.plan.solid_fraction = 0.6;
  EXPECT_EQ(failure([&] { check_fraction_ahead(s.plan, 0.59); }), "none");
  EXPECT_EQ(failure([&] { check_fraction_ahead(s.plan, 0.62); }),
            "sample.solid_fraction = 0.6 cannot be compressed to: the sample has a solid fraction "
            "of 0.62 before its compression; raise sample.solid_fraction");
}

// A run that presses its grains flat ends with that line instead of with numbers.
TEST(SampleRefusals, ARunThatCrushesItsGrainsFails) {
  SampleSetup s;
  s.plan.grains = 60;
  s.plan.boundary = "walls";
  s.plan.compress_to = "solid_fraction";
  s.plan.solid_fraction = 1.25;
  s.plan.deformation = "uniaxial";
  s.plan.strain = 0.01;
  s.plan.compression_rate = 20;
  s.material.normal_stiffness = 1e5;
  std::string found = "none";
  try {
    const auto run = make_sample_run(s, 1, 1);
    while (!run->done()) run->advance(10000);
  } catch (const ComputationFailed& e) {
    found = e.what();
  }
  EXPECT_THAT(found, HasSubstr("a grain is crushed after the compression"));
  EXPECT_THAT(found, HasSubstr("lower sample.solid_fraction"));
}

// Small strains count in what `check` tells.
TEST(SampleOutlook, CountsProbes) {
  SampleSetup s;
  s.plan.dim = 3;
  s.plan.shape = "sphere";
  s.plan.start_fraction = 0.2;
  s.plan.strain = 0.01;
  s.plan.strain_rate = 1;
  s.plan.compression_rate = 10;
  s.rest.background_damping = 1;
  const auto time = [&](const char* probe) {
    s.plan.probe = probe;
    return foresee_sample(s, {1}, 1000);
  };
  const Outlook none = time("none"), first = time("first"), both = time("both");
  // Six directions in a cell, forth and back, each within two decay times.
  EXPECT_GT(first.time - none.time, 12 * 2 / s.rest.background_damping);
  EXPECT_LT(first.time - none.time, 3 * 12 * 2 / s.rest.background_damping);
  EXPECT_NEAR(both.time - none.time, 2 * (first.time - none.time), 1e-9 * both.time);
  EXPECT_EQ(both.time_key, "rest.background_damping");
  EXPECT_NE(none.time_key, both.time_key);
}

// Spheres of the gap below the lid have the sizes of the grains.
TEST(SampleGap, SpheresFollowTheSizes) {
  SamplePlan p;
  p.dim = 3;
  p.shape = "sphere";
  p.filling = "dropped";
  p.boundary = "walls";
  p.grains = 1000;
  const auto radii = [&] {
    Random random(5);
    std::vector<double> out;
    for (int k = 0; k < 2000; ++k) out.push_back(draw_gap_radius(p, random) / p.radius);
    std::sort(out.begin(), out.end());
    return out;
  };
  p.sizes = "mono";
  EXPECT_EQ(radii().front(), 1);
  EXPECT_EQ(radii().back(), 1);
  p.sizes = "uniform";
  EXPECT_NEAR(radii().front(), 0.8, 0.01);
  EXPECT_NEAR(radii().back(), 1.2, 0.01);
  p.sizes = "bidisperse";
  p.size_ratio = 2;
  p.fraction_small = 0.25;
  std::vector<double> two = radii();
  EXPECT_NEAR(static_cast<double>(std::count(two.begin(), two.end(), 0.5)), 500, 60);
  EXPECT_EQ(std::count(two.begin(), two.end(), 0.5) + std::count(two.begin(), two.end(), 1.0),
            2000);
  p.shape = "superellipsoid";
  EXPECT_NEAR(radii().front(), 0.5, 0.01);
  EXPECT_NEAR(radii().back(), 1.5, 0.01);
  p.axes_times = "sizes";
  EXPECT_NEAR(radii().front(), 0.25, 0.01);
  EXPECT_NEAR(radii().back(), 1.5, 0.01);
  // The step is that of the least one.
  const std::vector<ShapedGrain> none;
  EXPECT_NEAR(sample_extremes(p, 2500, none).least_mass,
              2500 * 4.0 / 3 * std::numbers::pi * std::pow(0.25 * p.radius, 3),
              1e-6 * sample_extremes(p, 2500, none).least_mass);
}

}  // namespace
}  // namespace grainfield::dem
