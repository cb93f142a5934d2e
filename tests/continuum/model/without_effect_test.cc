// Settings without effect beside others are refused: model, parameter, what was found, what to do.
#include "continuum/without_effect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace grainfield::continuum;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

/// One line; "accepted" for settings that all have an effect.
std::string refusal(const std::string& model, const Settings& given) {
  const auto found = find_without_effect(find_model(model), given);
  return found ? found->parameter + "| " + found->refusal : "accepted";
}

}  // namespace

TEST(Idle, ConstantsBesideAMap) {
  for (const char* name : {"r", "t", "E_x", "E_y", "G", "nu_xy"})
    EXPECT_EQ(refusal("fe_orthotropic_layer", {{"map", "m.csv"}, {name, "0.5"}}),
              std::string(name) + "| model fe_orthotropic_layer: " + name +
                  " = 0.5 has no effect beside map = m.csv, which replaces it; leave one of the "
                  "two out");
  for (const char* name : {"E", "nu"})
    EXPECT_EQ(refusal("fe_mohr_coulomb_wedge", {{"map", "m.csv"}, {name, "0.4"}}),
              std::string(name) + "| model fe_mohr_coulomb_wedge: " + name +
                  " = 0.4 has no effect beside map = m.csv, which replaces it; leave one of the "
                  "two out");
  EXPECT_EQ(refusal("fe_orthotropic_layer", {{"map", "m.csv"}, {"h", "2"}}), "accepted");
  EXPECT_EQ(refusal("fe_mohr_coulomb_wedge", {{"map", ""}, {"E", "5"}}), "accepted");
}

TEST(Idle, RatiosBesideModuli) {
  const Settings moduli{{"E_x", "2"}, {"E_y", "1"}, {"G", "1"}, {"nu_xy", "0.2"}};
  EXPECT_EQ(refusal("fe_orthotropic_layer", moduli), "accepted");
  for (const char* name : {"r", "t"}) {
    Settings both = moduli;
    both[name] = "0.5";
    EXPECT_THAT(refusal("fe_orthotropic_layer", both),
                HasSubstr(std::string(name) + " = 0.5 has no effect beside E_x = 2, which replaces "
                                              "it; leave it out, or E_x, E_y and G"));
  }
  EXPECT_EQ(refusal("fe_orthotropic_layer", {{"r", "0.5"}, {"nu_xy", "0.2"}}), "accepted");
}

TEST(Idle, SpringsOfAnotherBase) {
  for (const char* base : {"closed", "rough", "smooth"})
    EXPECT_EQ(refusal("fe_cantelaube_core", {{"base", base}, {"base_stiffness", "2"}}),
              "base_stiffness| model fe_cantelaube_core: base_stiffness = 2 has no effect with "
              "base = " +
                  std::string(base) + "; leave it out or set base = elastic");
  EXPECT_EQ(refusal("fe_cantelaube_core", {{"base", "elastic"}, {"base_stiffness", "2"}}),
            "accepted");
  for (const char* heap : {"fe_mohr_coulomb_wedge", "fe_cone"}) {
    for (const char* base : {"rough", "smooth"})
      for (const char* name : {"base_stiffness", "base_friction_deg"})
        EXPECT_THAT(refusal(heap, {{"base", base}, {name, "20"}}),
                    AllOf(HasSubstr(std::string(name) + " = 20 has no effect with base = " + base),
                          HasSubstr("leave it out or set base = frictional")));
    EXPECT_EQ(refusal(heap, {{"base", "frictional"}, {"base_friction_deg", "20"}}), "accepted");
  }
}

TEST(Idle, LayersOfAHeapLaidAtOnce) {
  for (const char* heap : {"fe_mohr_coulomb_wedge", "fe_cone"}) {
    EXPECT_THAT(refusal(heap, {{"layers", "4"}}),
                HasSubstr("layers = 4 has no effect with history = at_once; leave it out or set "
                          "history = rise or grow"));
    for (const char* history : {"rise", "grow"})
      EXPECT_EQ(refusal(heap, {{"history", history}, {"layers", "4"}}), "accepted");
  }
}

TEST(Idle, AxisThatDoesNotYield) {
  const Settings solves{{"axis_iterations", "7"}};
  const auto with = [&](Settings more) {
    more.insert(solves.begin(), solves.end());
    return refusal("fe_cantelaube_core", more);
  };
  EXPECT_THAT(with({}),
              HasSubstr("axis_iterations = 7 has no effect with axis = branch, branch = zero: the "
                        "axis does not yield; leave it out, or set axis = yields or branch"));
  EXPECT_THAT(with({{"axis", "continuous"}, {"branch", "minus"}}), HasSubstr("has no effect"));
  EXPECT_EQ(with({{"branch", "minus"}}), "accepted");
  EXPECT_EQ(with({{"axis", "yields"}}), "accepted");
}

TEST(Idle, BranchBesideAnAngle) {
  const Settings angle{{"beta_hat_deg", "30"}, {"axis", "continuous"}};
  EXPECT_EQ(refusal("fe_cantelaube_core", angle), "accepted");
  Settings both = angle;
  both["branch"] = "minus";
  EXPECT_THAT(refusal("fe_cantelaube_core", both),
              HasSubstr("branch = minus has no effect beside beta_hat_deg = 30, which replaces its "
                        "angle; leave one of the two out, or set axis = yields"));
  both["axis"] = "yields";  // the branch says which stress is the largest
  EXPECT_EQ(refusal("fe_cantelaube_core", both), "accepted");
}

TEST(Idle, BranchesAndRaysOfClosedWedges) {
  for (const char* branch : {"minus", "zero", "plus"})
    EXPECT_EQ(refusal("cantelaube", {{"beta_hat_deg", "30"}, {"branch", branch}}),
              "branch| model cantelaube: branch = " + std::string(branch) +
                  " has no effect beside beta_hat_deg = 30, which replaces its angle; leave one "
                  "of the two out");
  EXPECT_EQ(refusal("cantelaube", {{"branch", "plus"}}), "accepted");
  EXPECT_EQ(refusal("cantelaube", {{"beta_hat_deg", "30"}}), "accepted");
  EXPECT_THAT(refusal("cantelaube_asymmetric", {{"yield_ray_deg", "5"}}),
              HasSubstr("yield_ray_deg = 5 has no effect with branch = zero; leave it out or set "
                        "branch = minus or plus"));
  for (const char* branch : {"minus", "plus"})
    EXPECT_EQ(refusal("cantelaube_asymmetric", {{"branch", branch}, {"yield_ray_deg", "5"}}),
              "accepted");
}

TEST(Idle, ReturnsFromAnAbsorbingBase) {
  EXPECT_THAT(refusal("osl_layer", {{"returns", "3"}}),
              HasSubstr("returns = 3 has no effect with base = absorbing; leave it out or set base "
                        "= reflecting"));
  EXPECT_EQ(refusal("osl_layer", {{"base", "reflecting"}, {"returns", "3"}}), "accepted");
}

TEST(Idle, FrictionOfWallsThatAreNot) {
  EXPECT_THAT(refusal("fe_osl_layer", {{"wall_friction", "0.3"}}),
              HasSubstr("wall_friction = 0.3 has no effect with sides = far; leave it out or set "
                        "sides = walls"));
  EXPECT_EQ(refusal("fe_osl_layer", {{"sides", "walls"}, {"wall_friction", "0.3"}}), "accepted");
}

TEST(Idle, NumericsOfTheOtherSolver) {
  for (const char* model : {"fe_osl_wedge", "fe_osl_layer"}) {
    for (const char* name : {"order", "rows"}) {
      EXPECT_THAT(refusal(model, {{"solver", "march"}, {name, "4"}}),
                  HasSubstr(std::string(name) + " = 4 has no effect with solver = march; leave it "
                                                "out or set solver = dg"));
      EXPECT_EQ(refusal(model, {{name, "4"}}), "accepted");
    }
    for (const auto& [name, value] : Settings{{"tolerance", "1e-6"}, {"steps", "50"}}) {
      EXPECT_THAT(refusal(model, {{name, value}}),
                  HasSubstr(name + " = " + value +
                            " has no effect with solver = dg; leave it out "
                            "or set solver = march"));
      EXPECT_EQ(refusal(model, {{"solver", "march"}, {name, value}}), "accepted");
    }
  }
}

TEST(Idle, ClosedOrthotropicBodies) {
  const Settings moduli{{"E_x", "2"}, {"E_y", "1"}, {"G", "1"}, {"nu_xy", "0.2"}};
  for (const char* model : {"orthotropic_half_plane", "orthotropic_layer"}) {
    EXPECT_EQ(refusal(model, moduli), "accepted");
    for (const char* name : {"r", "t"}) {
      Settings both = moduli;
      both[name] = "0.5";
      EXPECT_THAT(refusal(model, both), HasSubstr("has no effect beside E_x = 2"));
    }
  }
  EXPECT_THAT(
      refusal("orthotropic_half_plane", {{"nu_xy", "0.2"}}),
      HasSubstr("nu_xy = 0.2 has no effect beside r and t; leave it out or set E_x, E_y and "
                "G"));
  // A run may fill in a rough base.
  EXPECT_EQ(refusal("orthotropic_layer", {{"nu_xy", "0.2"}}), "accepted");
  EXPECT_EQ(refusal("orthotropic_layer", {{"nu_xy", "0.2"}, {"base", "rough"}}), "accepted");
}

TEST(Idle, TentProfilesWithoutABend) {
  EXPECT_THAT(refusal("liffman", {{"bend", "0.2"}}),
              HasSubstr("bend = 0.2 has no effect with top_alpha_deg = 0, a triangle; leave it out "
                        "or set top_alpha_deg"));
  EXPECT_THAT(refusal("liffman", {{"bend", "0.5"}, {"top_alpha_deg", "20"}}),
              HasSubstr("top_alpha_deg = 20 has no effect with bend = 0.5, on the axis; leave it "
                        "out or set bend below 0.5"));
  EXPECT_EQ(refusal("liffman", {{"bend", "0.2"}, {"top_alpha_deg", "20"}}), "accepted");
  EXPECT_EQ(refusal("liffman", {{"alpha_deg", "20"}}), "accepted");
}

TEST(Idle, MakeModelRefuses) {
  try {
    make_model("fe_cantelaube_core", {{"base", "rough"}, {"base_stiffness", "2"}});
    FAIL();
  } catch (const BadParameter& error) {
    EXPECT_THAT(error.what(), HasSubstr("base_stiffness = 2 has no effect with base = rough"));
  }
}
