// The finite-element half plane against Flamant, and what is felt of the mesh's end.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "continuum/model.h"

using namespace grainfield::continuum;

namespace {

/// Random points between half and twice the depth of interest, and below the load.
Points cone() {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(0, 1);
  Points points(2000, 2);
  for (int n = 0; n < points.rows(); ++n) {
    const double depth = 0.15 * 0.5 * std::pow(4, any(random));
    points.row(n) << 3 * depth * (2 * any(random) - 1), -depth;
  }
  points.topRows(200).col(0) *= 0.05;
  return points;
}

}  // namespace

TEST(FeHalfPlane, MeetsFlamantAtEveryPoissonRatio) {
  const Points points = cone();
  const Stresses expected = make_model("flamant", {{"F", "2"}})->stress(points);
  for (const char* nu : {"0", "0.3", "0.45"}) {
    const auto model = make_model("fe_elastic_half_space", {{"F", "2"}, {"nu", nu}});
    const Stresses found = model->stress(points);
    for (int i = 0; i < points.rows(); ++i) {
      const double peak = 2 * 2 / M_PI / -points(i, 1);  // at this depth
      EXPECT_LT((found - expected).row(i).cwiseAbs().maxCoeff(), 5e-3 * peak)
          << "nu " << nu << " at " << points.row(i);
    }
    EXPECT_NEAR(model->figures().at("patch_width"), 0.05 * 0.15, 1e-12);
  }
}

TEST(FeHalfPlane, TheMeshsEndIsFeltInProportionToOneOverItsDistance) {
  // Holding the end fixed hinders a uniform sigma_xx of order F / R; nothing else is felt.
  const auto below = [](const char* radius) {
    return make_model("fe_elastic_half_space", {{"radius", radius}, {"tolerance", "1"}})
        ->stress((Points(1, 2) << 0.15, -0.15).finished());
  };
  const Stresses far = below("100000");
  const double at_50 = (below("50") - far)(0, 0), at_100 = (below("100") - far)(0, 0),
               at_200 = (below("200") - far)(0, 0);
  EXPECT_NEAR(std::log2(at_50 / at_100), 1, 0.2);
  EXPECT_NEAR(std::log2(at_100 / at_200), 1, 0.2);
  EXPECT_LT(std::abs(below("10000")(0, 0) - far(0, 0)), 5e-4 * std::abs(far(0, 0)));
}

TEST(FeHalfPlane, UnderAWideStripTheStressIsTheStrips) {
  // Strip of width b: on the axis sigma_yy = -(p/pi) (2 a + sin 2 a), a = atan(b / 2d).
  const auto model = make_model("fe_elastic_half_space", {{"patch", "1"}});
  for (const double d : {0.1, 0.15, 0.3}) {
    const double a = std::atan(0.15 / 2 / d);
    const double expected = -(2 * a + std::sin(2 * a)) / M_PI / 0.15;
    EXPECT_NEAR(model->stress((Points(1, 2) << 0, -d).finished())(0, 1), expected,
                5e-3 * std::abs(expected));
  }
}
