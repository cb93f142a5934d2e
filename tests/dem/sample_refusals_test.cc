// Setups of samples whose parts do not go together.
#include <gmock/gmock.h>

#include <limits>

#include "dem/study/sample.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

std::string refusal(const SampleSetup& setup) {
  try {
    foresee_sample(setup, {1}, 10);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "none";
}

TEST(SampleRefusals, WhatDoesNotGoTogether) {
  SampleSetup s;
  EXPECT_EQ(refusal(s), "none");
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
      EXPECT_EQ(refusal(s), "none");
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

}  // namespace
}  // namespace grainfield::dem
