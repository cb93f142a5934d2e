// The transversely isotropic layer by finite elements on coarse meshes against the closed form:
// finer meshes are nearer to it. The fine ones: fe_transverse_long_test.cc.
#include <gtest/gtest.h>

#include "tests/continuum/fe_transverse_scene.h"

namespace grainfield::continuum {
namespace {

TEST(FeTransverseLayer, ComesNearerToTheHankelIntegralsOnFinerMeshes) {
  Settings settings = kTransverseCases[0].moduli;
  settings["base"] = "rough";
  const auto exact = make_model("transverse_layer", settings);
  settings.insert({{"half_width", "3"}, {"tolerance", "1"}, {"refinements", "1"}});
  double before = 0;
  for (const char* cells : {"2", "4"}) {
    settings["cells"] = cells;
    const auto elements = make_model("fe_transverse_layer", settings);
    double error = 0;
    for (const double depth : {0.5, 1.})
      error = std::max(error, transverse_error(*elements, *exact, depth, 0.8 / depth));
    if (before > 0) {
      // Order 2 of the recovered stress; the sides at three depths are felt by less than a percent.
      EXPECT_LT(error, before / 2);
      EXPECT_LT(error, 1.5e-2);
    }
    before = error;
  }
}

TEST(FeTransverseLayer, IsTheIsotropicOneWhereItIsIsotropic) {
  const Settings numerics{
      {"half_width", "2"}, {"cells", "1"}, {"tolerance", "1"}, {"refinements", "1"}};
  Settings one = numerics, other = numerics;
  one.insert({{"nu_h", "0.3"}, {"nu_v", "0.3"}});
  other.insert({{"nu", "0.3"}, {"E", "1"}, {"dim", "3"}});
  const Points points = transverse_points(0.7, 1);
  const Stresses a = make_model("fe_transverse_layer", one)->stress(points);
  const Stresses b = make_model("fe_elastic_layer", other)->stress(points);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-6 * b.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace grainfield::continuum
