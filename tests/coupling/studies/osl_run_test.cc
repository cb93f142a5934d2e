// The shipped studies of oriented stress linearity: both solvers beside the closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/coupling/shipped.h"

using namespace grainfield::coupling;
using grainfield::coupling::testing::number;
using grainfield::coupling::testing::shipped;

TEST(OslRun, HeapMeetsTheClosedFormWhereTheMeshIsAligned) {
  const StudyResult result = shipped("osl-wedge.toml");
  EXPECT_LT(number(result, "compare.dg.rel_l2"), 1e-12);
  EXPECT_LT(number(result, "compare.march.rel_l2"), 1e-6);
  EXPECT_LT(number(result, "compare.dg_rays.rel_l2"), 2e-3);
  EXPECT_LT(number(result, "compare.dg_box.rel_l2"), 0.02);
  for (const char* model : {"dg", "dg_rays", "dg_box", "march"})
    EXPECT_LT(number(result, std::string("model.") + model + ".force_balance"), 1e-11) << model;
}

TEST(OslRun, LayerShowsTwoPeaks) {
  const StudyResult result = shipped("osl-layer.toml");
  EXPECT_EQ(number(result, "response.peaks"), 2);
  EXPECT_LT(number(result, "compare.dg.rel_l2"), 5e-3);
  EXPECT_LT(number(result, "compare.march.rel_l2"), 3e-2);
  EXPECT_NEAR(number(result, "model.dg.base_force"), 300, 1e-9);
}

TEST(OslRun, RefusesWhatDoesNotFit) {
  try {
    shipped("osl-wedge.toml", {"problem.depths=[2.0]"});
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(),
                ::testing::HasSubstr("problem.depths: found 2, allowed: up to problem.h"));
  }
  EXPECT_THROW(shipped("osl-layer.toml", {"compare.models=[\"dg\"]"}), std::invalid_argument);
  EXPECT_THROW(shipped("osl-layer.toml", {"problem.dim=3"}), std::invalid_argument);
}
