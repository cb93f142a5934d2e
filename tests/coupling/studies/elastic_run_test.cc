// The shipped studies of the orthotropic layer and of Cantelaube's core.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/coupling/shipped.h"

using namespace grainfield::coupling;
using grainfield::coupling::testing::number;
using grainfield::coupling::testing::shipped;

TEST(ElasticRun, OrthotropicLayerGoesFromOnePeakToTwo) {
  for (const auto& [r, peaks] : {std::pair{"1", 1}, {"-0.6", 2}}) {
    const StudyResult result =
        shipped("orthotropic-layer.toml",
                {"sweep.key=\"\"", "sweep.values=[]", std::string("problem.r=") + r,
                 "model.fe.tolerance=2e-3", "model.fe_rough.tolerance=2e-3"});
    EXPECT_EQ(number(result, "response.peaks"), peaks) << r;
    EXPECT_EQ(number(result, "model.half_plane.peaks"), peaks) << r;
    // A quarter of the depth below the load the base is hardly felt.
    EXPECT_LT(number(result, "compare.half_plane.depth_0.0375.rel_l2"), 0.03) << r;
    EXPECT_GT(number(result, "compare.half_plane.depth_0.15.rel_l2"), 0.2) << r;
    EXPECT_GT(number(result, "response.peak"), number(result, "compare.fe_rough.peak")) << r;
  }
}

TEST(ElasticRun, CantelaubesCoreIsTheClosedFormOnItsOwnBaseOnly) {
  const StudyResult result = shipped(
      "wedge-cantelaube-core.toml",
      {"model.fe_rough.adaptive=0", "model.fe_smooth.adaptive=0", "model.fe_springs.adaptive=0"});
  EXPECT_LT(number(result, "compare.fe_closed.rel_l2"), 1e-8);
  for (const char* model : {"fe_rough", "fe_smooth", "fe_springs"}) {
    EXPECT_GT(number(result, std::string("compare.") + model + ".rel_l2"), 0.03) << model;
    // A peak on the axis instead of the plateau.
    EXPECT_EQ(number(result, std::string("model.") + model + ".dip_ratio"), 1) << model;
    EXPECT_GT(number(result, std::string("model.") + model + ".base_centre"), 0.75) << model;
  }
}

TEST(ElasticRun, ElementsReturnTheLayersAndTheHalfSpacesClosedForms) {
  for (const char* name : {"elastic-layer.toml", "elastic-half-space.toml"})
    EXPECT_FALSE(shipped(name).comparison.results.empty()) << name;
}
