// Cantelaube's core as a boundary value problem over friction angles, branches and bases.
#include <gtest/gtest.h>

#include <cmath>

#include "continuum/model.h"
#include "tests/continuum/cantelaube_core_scene.h"

using namespace grainfield::continuum;
using grainfield::continuum::testing::figure;
using grainfield::continuum::testing::kExact;
using grainfield::continuum::testing::kExactYielding;
using grainfield::continuum::testing::over_the_heap;

TEST(CantelaubeCoreSlow, ClosedFormIsTheSolution) {
  for (const auto& [phi, nu] : {std::pair{"15", "0.45"}, {"28", "0.3"}, {"40", "0"}}) {
    for (const char* branch : {"zero", "minus", "plus"}) {
      const Settings heap = {{"phi_deg", phi}, {"branch", branch}, {"rho_g", "3"}};
      Settings core = heap;
      core.insert({{"nu", nu}, {"h", "2"}, {"refinement", "2"}});
      const auto elements = make_model("fe_cantelaube_core", core);
      const auto closed = make_model("cantelaube", heap);
      const Points points = over_the_heap(std::stod(phi), 2);
      const Stresses found = elements->stress(points), exact = closed->stress(points);
      const double tolerance = branch == std::string("zero") ? kExact : kExactYielding;
      EXPECT_LT((found - exact).cwiseAbs().maxCoeff(), tolerance * 6) << phi << " " << branch;
      EXPECT_LT(figure(elements, "closed_form_error"), tolerance) << phi << " " << branch;
      EXPECT_LT(figure(elements, "flank_jump"), tolerance) << phi << " " << branch;
      EXPECT_NEAR(figure(elements, "mobilised_sine_ratio"), 1, 1e-5) << phi << " " << branch;
    }
  }
}

// The closed form is linear in the stress: elements of degree one approach it at their order.
TEST(CantelaubeCoreSlow, DegreeOneConvergesToIt) {
  double before = 0;
  for (const char* refinement : {"3", "4", "5"}) {
    const auto model =
        make_model("fe_cantelaube_core", {{"degree", "1"}, {"refinement", refinement}});
    const auto closed = make_model("cantelaube", {{"branch", "zero"}});
    const Points points = over_the_heap(28, 0.95);
    const double error =
        std::sqrt((model->stress(points) - closed->stress(points)).array().square().mean());
    if (before > 0) {
      EXPECT_GT(std::log2(before / error), 0.8) << refinement;
    }
    before = error;
  }
  EXPECT_LT(before, 4e-3);
}

// The flank's tractions alone do not choose the core's angle; that the stress along its boundary is
// continuous does, and on the closed form's own base chooses the branch of the axis' condition.
TEST(CantelaubeCoreSlow, ContinuityAtTheFlankChoosesTheBranch) {
  const auto jump = [](double beta_hat, const char* axis, const char* branch) {
    Settings settings{
        {"beta_hat_deg", std::to_string(beta_hat)}, {"axis", axis}, {"refinement", "2"}};
    if (axis == std::string("yields")) settings["branch"] = branch;
    const auto model = make_model("fe_cantelaube_core", settings);
    model->stress(Points(0, 2));
    return figure(model, "flank_jump");
  };
  for (const auto& [axis, branch] :
       {std::pair{"continuous", "zero"}, {"yields", "minus"}, {"yields", "plus"}}) {
    const auto closed = make_model("cantelaube", {{"branch", branch}});
    const double chosen = figure(closed, "beta_hat_deg");
    const double at = jump(chosen, axis, branch);
    EXPECT_LT(at, 1e-5) << branch;
    for (const double off : {-2., 2.})
      EXPECT_GT(jump(chosen + off, axis, branch), 1e-3) << branch << " " << off;
  }
}

TEST(CantelaubeCoreSlow, OtherBasesBearTheSameWeight) {
  // The closed form's force on the base of the core: what any base must bear.
  const auto force = [](const std::unique_ptr<Model>& model) {
    const int n = 801;
    const double width = std::tan(38.634 * M_PI / 180) - 1e-3;
    Points points(n, 2);
    for (int i = 0; i < n; ++i) points.row(i) << -width + 2 * width * i / (n - 1), -1;
    const Eigen::VectorXd p = -model->stress(points).col(1);
    return (p.sum() - (p[0] + p[n - 1]) / 2) * 2 * width / (n - 1);
  };
  const double closed = force(make_model("cantelaube", {{"branch", "zero"}}));
  for (const auto& settings :
       {Settings{{"base", "rough"}}, {{"base", "smooth"}}, {{"base", "elastic"}}}) {
    Settings all = settings;
    all.insert({"adaptive", "2"});
    const auto model = make_model("fe_cantelaube_core", all);
    EXPECT_NEAR(force(model), closed, 5e-3 * closed) << settings.at("base");
    EXPECT_GT(figure(model, "closed_form_error"), 1e-2) << settings.at("base");
  }
  // Ever stiffer springs are a rigid base.
  const auto stress_on = [](const Settings& settings) {
    const auto model = make_model("fe_cantelaube_core", settings);
    return model->stress((Points(3, 2) << 0, -1, 0.3, -1, 0.2, -0.6).finished());
  };
  const Stresses rigid = stress_on({{"base", "rough"}});
  double before = 0;
  for (const char* stiffness : {"100", "1000"}) {
    const double difference =
        (stress_on({{"base", "elastic"}, {"base_stiffness", stiffness}}) - rigid)
            .cwiseAbs()
            .maxCoeff();
    if (before > 0) {
      EXPECT_LT(difference, 0.2 * before) << stiffness;
    }
    before = difference;
  }
  EXPECT_LT(before, 0.02);
}
