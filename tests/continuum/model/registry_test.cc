// Settings of models: what is wrong, what was found, what is allowed, the nearest name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "continuum/model.h"
#include "tests/continuum/refused_model.h"

using namespace grainfield::continuum;
using testing::HasSubstr;

TEST(Registry, UnknownModelNamesTheNearest) {
  EXPECT_THAT(refusal("flamand", {}), HasSubstr("no model 'flamand'; did you mean 'flamant'?"));
}

TEST(Registry, UnknownParameterNamesTheNearest) {
  EXPECT_THAT(refusal("layer", {{"bse", "rough"}}),
              HasSubstr("layer: no parameter 'bse'; did you mean 'base'? allowed: F, h, nu, base"));
}

TEST(Registry, OutOfRangeSaysWhatIsAllowed) {
  EXPECT_THAT(refusal("layer", {{"nu", "0.6"}}),
              HasSubstr("nu = 0.6 is out of range; allowed: 0 to 0.5"));
  EXPECT_THAT(refusal("boussinesq", {{"nu", "-0.1"}}), HasSubstr("nu = -0.1"));
  EXPECT_THAT(refusal("layer", {{"h", "0"}}), HasSubstr("allowed: above 0 m"));
}

TEST(Registry, CountsAreWholeNumbers) {
  EXPECT_THAT(refusal("fe_elastic_layer", {{"degree", "2.5"}}),
              HasSubstr("degree = 2.5 is out of range; allowed: whole numbers 0 to 4"));
  EXPECT_THAT(refusal("fe_elastic_half_space", {{"radius", "2"}}),
              HasSubstr("radius = 2 is out of range; allowed: 0, or at least 4"));
}

TEST(Registry, MeshesThatTakeTooMuchMemoryAreRefused) {
  for (const char* heap : {"fe_mohr_coulomb_wedge", "fe_cone"})
    EXPECT_THAT(
        refusal(heap, {{"cells", "1000"}}),
        HasSubstr("cells = 1000 ask for 4e+06 unknowns; allowed: up to 2e+06; lower cells"));
  EXPECT_THAT(refusal("fe_transverse_layer", {{"cells", "40"}}),
              HasSubstr("cells = 40, half_width = 8, degree = 0 ask for 3.9e+08 unknowns"));
  EXPECT_THAT(refusal("fe_orthotropic_layer", {{"cells", "100"}}),
              HasSubstr("cells = 100, half_width = 8, degree = 0 ask for 2.9e+06 unknowns"));
  EXPECT_THAT(refusal("fe_transverse_half_space", {{"cells", "10"}}),
              HasSubstr("cells = 10, degree = 0 ask for 4e+06 unknowns"));
  EXPECT_THAT(refusal("fe_cantelaube_core", {{"refinement", "10"}}),
              HasSubstr("refinement = 10, degree = 2 ask for 2.5e+07 unknowns"));
}

TEST(Registry, NotANumber) {
  for (const char* text : {"", "1x", "deep", "nan", "inf", "1e999"})
    EXPECT_THAT(refusal("layer", {{"h", text}}), HasSubstr("is not a number")) << text;
}

TEST(Registry, WrongChoiceNamesTheNearest) {
  EXPECT_THAT(refusal("layer", {{"base", "ruogh"}}),
              HasSubstr("base = 'ruogh' is not one of smooth, rough; did you mean 'rough'?"));
}

TEST(Registry, EveryModelIsDocumentedAndItsDefaultsAreAllowed) {
  std::set<std::string> names;
  for (const auto& info : registry()) {
    EXPECT_TRUE(names.insert(info.name).second);
    EXPECT_FALSE(info.summary.empty());
    for (const auto& parameter : info.parameters) {
      EXPECT_FALSE(parameter.unit.empty()) << info.name << " " << parameter.name;
      EXPECT_FALSE(parameter.meaning.empty()) << info.name << " " << parameter.name;
      EXPECT_FALSE(parameter.source.empty()) << info.name << " " << parameter.name;
      EXPECT_FALSE(allowed(parameter).empty());
    }
    EXPECT_NO_THROW(make_model(info.name, {}));
    const int dim = dimension(info, {});
    EXPECT_TRUE(dim == 2 || dim == 3);
  }
}

// A number above 0 that is no normal one is told the bound that it misses.
TEST(Registry, NumbersTooSmallToCountAreToldTheBound) {
  const auto refusal = [](const std::string& height) -> std::string {
    try {
      make_model("layer", {{"h", height}});
    } catch (const BadParameter& error) {
      return error.what();
    }
    return "accepted";
  };
  for (const std::string h : {"1e-320", "1e-400", "1e-61"})
    EXPECT_EQ(refusal(h), "model layer: h = " + h + " is out of range; allowed: at least 1e-60 m");
  for (const std::string h : {"1e61", "1e308"})
    EXPECT_EQ(refusal(h), "model layer: h = " + h +
                              " is out of range; allowed: above 0 m, and no " +
                              "more than 1e+60 in size");
  for (const std::string h : {"0", "-0.0", "-1e-320", "-3"})
    EXPECT_EQ(refusal(h), "model layer: h = " + h + " is out of range; allowed: above 0 m");
}
