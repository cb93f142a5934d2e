// Transversely isotropic layer and half space by finite elements within 0.3 % of each depth's
// largest component of the closed forms. In the half space no closed form enters the elements.
#include <gtest/gtest.h>

#include "tests/continuum/fe_transverse_scene.h"

namespace grainfield::continuum {
namespace {

constexpr double kAsked = 3e-3;

class FeTransverse : public testing::TestWithParam<TransverseCase> {};

TEST_P(FeTransverse, LayerMeetsTheHankelIntegrals) {
  for (const char* base : {"smooth", "rough"}) {
    Settings settings = GetParam().moduli;
    settings["base"] = base;
    const auto exact = make_model("transverse_layer", settings);
    settings["half_width"] = "5";
    const auto elements = make_model("fe_transverse_layer", settings);
    for (const double depth : {0.5, 0.75, 1.})
      EXPECT_LT(transverse_error(*elements, *exact, depth, 0.8 / depth), kAsked)
          << base << " " << depth;
  }
}

TEST_P(FeTransverse, HalfSpaceMeetsElliott) {
  const auto exact = make_model("transverse_half_space", GetParam().moduli);
  const auto elements = make_model("fe_transverse_half_space", GetParam().moduli);
  for (const double depth : {0.075, 0.1125, 0.15})
    EXPECT_LT(transverse_error(*elements, *exact, depth, 2), kAsked) << depth;
}

INSTANTIATE_TEST_SUITE_P(Moduli, FeTransverse, testing::ValuesIn(kTransverseCases),
                         [](const testing::TestParamInfo<TransverseCase>& tested) {
                           std::string name = tested.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

}  // namespace
}  // namespace grainfield::continuum
