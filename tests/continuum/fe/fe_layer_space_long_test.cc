// The layer in space by finite elements on a rough base, where Hooke's law itself counts, against
// the Hankel integrals of the closed form: all components, three depths, off the axes too.
#include <gtest/gtest.h>

#include <string>

#include "continuum/model.h"

namespace grainfield::continuum {
namespace {

class RoughLayer : public testing::TestWithParam<const char*> {};

TEST_P(RoughLayer, MeetsTheHankelIntegrals) {
  Settings settings{{"dim", "3"}, {"base", "rough"}, {"nu", GetParam()}, {"F", "1"}, {"h", "1"}};
  const auto exact = make_model("layer", settings);
  settings["half_width"] = "5";
  const auto elements = make_model("fe_elastic_layer", settings);
  constexpr double depths[] = {0.5, 0.75, 1};
  Points points(12, 3);
  int row = 0;
  for (const double depth : depths) {
    for (const double r : {0.0, 0.3, 0.8}) points.row(row++) << r, 0, -depth;
    points.row(row++) << -0.48, 0.64, -depth;
  }
  const Stresses a = exact->stress(points), b = elements->stress(points);
  ASSERT_TRUE(a.allFinite() && b.allFinite());
  for (int k = 0; k < 12; k += 4) {
    const double peak = a.middleRows(k, 4).cwiseAbs().maxCoeff();
    EXPECT_LT((a - b).middleRows(k, 4).cwiseAbs().maxCoeff(), 3e-3 * peak)
        << "nu " << GetParam() << ", depth " << depths[k / 4];
  }
}

INSTANTIATE_TEST_SUITE_P(Poisson, RoughLayer, testing::Values("0", "0.3", "0.45"));

}  // namespace
}  // namespace grainfield::continuum
