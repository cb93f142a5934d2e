// A suite that runs at each number of lanes: INSTANTIATE_TEST_SUITE_P with testing::Values(2, 4,
// 8).
#pragma once
#include <gtest/gtest.h>

#include "dem/space/lane_width.h"

namespace grainfield::dem {

/// The lanes are as wide as the parameter while a test runs; skipped where the processor has none
/// so wide.
class AtLaneWidth : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!use_lane_width(GetParam())) GTEST_SKIP() << "not in this processor: " << GetParam();
  }
  void TearDown() override { use_lane_width(before_); }

 private:
  int before_ = lane_width();
};

}  // namespace grainfield::dem
