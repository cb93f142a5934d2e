// The elastic core of Cantelaube's heap as a boundary value problem: its closed form is the
// solution; refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "continuum/model.h"
#include "tests/continuum/cantelaube_core_scene.h"
#include "tests/continuum/refused_model.h"

using namespace grainfield::continuum;
using grainfield::continuum::testing::figure;
using grainfield::continuum::testing::kExact;
using grainfield::continuum::testing::kExactYielding;
using grainfield::continuum::testing::over_the_heap;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

std::string refusal(const Settings& settings) {
  return grainfield::continuum::refusal("fe_cantelaube_core", settings);
}

}  // namespace

TEST(CantelaubeCore, ClosedFormIsTheSolution) {
  for (const auto& [phi, branch] : {std::pair{"28", "zero"}, {"40", "zero"}, {"28", "minus"}}) {
    const Settings heap = {{"phi_deg", phi}, {"branch", branch}, {"rho_g", "3"}};
    Settings core = heap;
    core.insert({{"h", "2"}, {"refinement", "1"}});
    const auto elements = make_model("fe_cantelaube_core", core);
    const Points points = over_the_heap(std::stod(phi), 2);
    const Stresses exact = make_model("cantelaube", heap)->stress(points);
    const double tolerance = branch == std::string("zero") ? kExact : kExactYielding;
    EXPECT_LT((elements->stress(points) - exact).cwiseAbs().maxCoeff(), tolerance * 6) << branch;
    EXPECT_LT(figure(elements, "flank_jump"), tolerance) << phi << " " << branch;
  }
}

TEST(CantelaubeCore, RigidBaseBearsMoreInTheMiddle) {
  const auto model = make_model("fe_cantelaube_core", {{"base", "rough"}, {"refinement", "3"}});
  model->stress(Points(0, 2));
  // The closed form's plateau is 0.702.
  EXPECT_GT(figure(model, "base_centre"), 0.78);
  EXPECT_EQ(figure(model, "dip_ratio"), 1);
}

// Branch plus with its yielding axis on springs: the mesh decides nothing, the axis is at its
// limit.
TEST(CantelaubeCore, YieldingAxisOnSprings) {
  double last = 0;
  for (const char* refinement : {"2", "3", "4"}) {
    const auto model =
        make_model("fe_cantelaube_core",
                   {{"branch", "plus"}, {"base", "elastic"}, {"refinement", refinement}});
    model->stress(Points(0, 2));
    EXPECT_LT(figure(model, "axis_misfit"), 1e-8);
    const double centre = figure(model, "base_centre");
    if (last > 0) {
      EXPECT_NEAR(centre, last, 3e-3) << refinement;
    }
    last = centre;
  }
  EXPECT_NEAR(last, 0.809, 1e-3);  // of 0.855 in the closed form
}

TEST(CantelaubeCore, OutsideIsNanAndSettingsAreChecked) {
  const auto model = make_model("fe_cantelaube_core", {{"refinement", "1"}});
  const auto out = model->stress((Points(4, 2) << 0, 0.1, 0, -1.01, 2, -1, NAN, -0.5).finished());
  EXPECT_TRUE(out.array().isNaN().all());
  EXPECT_THAT(refusal({{"beta_hat_deg", "62"}, {"axis", "continuous"}}),
              HasSubstr("beta_hat_deg = 62 is not inside the heap; allowed: above 0 and below 90 - "
                        "phi_deg = 62 deg"));
  EXPECT_THAT(refusal({{"beta_hat_deg", "30"}}), HasSubstr("allowed: axis = continuous or yields"));
  for (const char* base : {"rough", "smooth", "elastic"}) {
    EXPECT_THAT(
        refusal({{"branch", "minus"}, {"base", base}}),
        AllOf(HasSubstr("is not solved with a yielding axis (axis = branch, branch = minus); "
                        "allowed: base = closed, base = elastic with branch = plus, or axis = "
                        "continuous"),
              HasSubstr(base)));
    EXPECT_THAT(refusal({{"axis", "yields"}, {"base", base}}), HasSubstr("allowed: base = closed"));
    EXPECT_EQ(refusal({{"branch", "minus"}, {"base", base}, {"axis", "continuous"}}), "accepted");
  }
  const auto failing = make_model(
      "fe_cantelaube_core", {{"branch", "minus"}, {"axis_iterations", "1"}, {"refinement", "1"}});
  try {
    failing->stress(Points(0, 2));
    FAIL();
  } catch (const grainfield::ComputationFailed& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("the axis misses its yield condition by"));
    EXPECT_THAT(failure.what(), HasSubstr("raise axis_iterations"));
  }
  const auto unsolved = make_model("fe_cantelaube_core", {{"iterations", "1"}});
  try {
    unsolved->stress(Points(0, 2));
    FAIL();
  } catch (const grainfield::ComputationFailed& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("conjugate gradients stopped after 1 iterations"));
    EXPECT_THAT(failure.what(), HasSubstr("raise iterations"));
  }
}
