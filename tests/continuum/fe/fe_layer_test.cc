// The finite-element layer against the closed form of the unbounded layer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "continuum/model.h"

using namespace grainfield::continuum;

namespace {

Points along(double depth, double least, double most, int n) {
  Points points(n, 2);
  for (int i = 0; i < n; ++i) points.row(i) << least + (most - least) * i / (n - 1), -depth;
  return points;
}

}  // namespace

TEST(FeLayer, MeetsTheClosedFormOnTheBaseAndInside) {
  for (const char* base : {"smooth", "rough"}) {
    for (const char* nu : {"0", "0.2", "0.3", "0.45"}) {
      const Settings settings = {{"F", "300"}, {"h", "0.15"}, {"nu", nu}, {"base", base}};
      const auto elements = make_model("fe_elastic_layer", settings);
      const auto closed = make_model("layer", settings);
      for (const double depth : {0.15, 0.1, 0.03}) {
        const Points points = along(depth, -0.6, 0.6, 49);
        const Stresses expected = closed->stress(points), found = elements->stress(points);
        const double peak = expected.col(1).cwiseAbs().maxCoeff();
        EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-3 * peak)
            << base << " nu " << nu << " depth " << depth;
      }
      EXPECT_LE(elements->figures().at("change"), 2e-4);
      EXPECT_LE(elements->figures().at("residual"), 1.01e-10);
    }
  }
}

TEST(FeLayer, StressDoesNotDependOnYoungsModulusAndScalesWithTheLoad) {
  const Points points = along(0.5, -1, 1, 5);
  const auto soft = make_model("fe_elastic_layer", {{"E", "1"}})->stress(points);
  const auto hard = make_model("fe_elastic_layer", {{"E", "1e11"}, {"F", "2"}})->stress(points);
  EXPECT_LT((hard - 2 * soft).cwiseAbs().maxCoeff(), 1e-6 * soft.cwiseAbs().maxCoeff());
}

TEST(FeLayer, RigidSidesCarryTheHindredSpreading) {
  // A smooth base lets the layer spread by nu (1 + nu) F / E; rigid walls at +-L take it back by
  // the uniform stress -nu / (1 - nu) F / (2 L).
  const Settings walls = {{"sides", "smooth"}, {"half_width", "8"}, {"nu", "0.3"}};
  const Points points = along(0.6, 1, 6, 6);
  const auto with = make_model("fe_elastic_layer", walls)->stress(points);
  const auto without = make_model("layer", {{"nu", "0.3"}})->stress(points);
  for (int i = 0; i < points.rows(); ++i) {
    EXPECT_NEAR(with(i, 0) - without(i, 0), -0.3 / 0.7 / 16, 2e-4);
    EXPECT_NEAR(with(i, 1), without(i, 1), 2e-4);
  }
}

TEST(FeLayer, OutsideIsNan) {
  const auto model = make_model("fe_elastic_layer", {{"half_width", "3"}});
  const auto out =
      model->stress((Points(5, 2) << 0, 0.1, 0, 0, 0, -1.01, 3.01, -0.5, NAN, -0.5).finished());
  EXPECT_TRUE(out.array().isNaN().all());
  EXPECT_TRUE(model->stress((Points(2, 2) << 3, -1, -3, -0.5).finished()).array().isFinite().all());
  EXPECT_EQ(model->stress(Points(0, 2)).rows(), 0);
}

TEST(FeLayer, FailuresSayWhatToChange) {
  using testing::HasSubstr;
  const Points point = along(1, 0, 1, 2);
  const auto message = [&](const Settings& settings) -> std::string {
    try {
      make_model("fe_elastic_layer", settings)->stress(point);
    } catch (const grainfield::ComputationFailed& failure) {
      return failure.what();
    }
    return "no failure";
  };
  EXPECT_THAT(message({{"iterations", "2"}}),
              HasSubstr("conjugate gradients stopped after 2 iterations"));
  EXPECT_THAT(message({{"iterations", "2"}}), HasSubstr("raise iterations"));
  EXPECT_THAT(message({{"tolerance", "1e-9"}, {"refinements", "1"}}),
              HasSubstr("raise refinements, degree or tolerance"));
  EXPECT_THAT(message({{"tolerance", "1e-9"}, {"refinements", "20"}, {"most_unknowns", "3000"}}),
              testing::AllOf(HasSubstr("fe_elastic_layer: the next refinement would have about "),
                             HasSubstr("allowed: up to most_unknowns = 3000; lower refinements")));
}

TEST(FeLayer, RefusesANearlyIncompressibleMaterial) {
  EXPECT_THROW(make_model("fe_elastic_layer", {{"nu", "0.5"}}), BadParameter);
  EXPECT_THROW(make_model("fe_elastic_layer", {{"dim", "4"}}), BadParameter);
}
