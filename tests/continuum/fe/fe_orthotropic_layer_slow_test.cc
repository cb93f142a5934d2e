// The orthotropic layer against a Fourier integral of its own; its load and peaks; maps of
// constants that vary.
#include <gtest/gtest.h>

#include <cmath>

#include "continuum/closed/orthotropic.h"
#include "continuum/model.h"
#include "tests/continuum/orthotropic_layer_oracle.h"
#include "tests/continuum/orthotropic_layer_scene.h"

using namespace grainfield::continuum;
using grainfield::continuum::testing::along;
using grainfield::continuum::testing::exact_base;
using grainfield::continuum::testing::Map;
using grainfield::continuum::testing::text_of;

TEST(FeOrthotropicLayer, MeetsTheFourierTransformOnTheBase) {
  struct Medium {
    double r, t, nu;
  };
  for (const auto& [r, t, nu] : {Medium{-0.8, 1, 0.9}, {2.5, 0.4, 0.1}, {-0.2, 3, 1.1}}) {
    for (const bool rough : {false, true}) {
      const auto model = make_model("fe_orthotropic_layer", {{"r", text_of(r)},
                                                             {"t", text_of(t)},
                                                             {"nu_xy", text_of(nu)},
                                                             {"base", rough ? "rough" : "smooth"}});
      const Points points = along(1, 0, 3, 7);
      const Stresses found = model->stress(points);
      for (int i = 0; i < points.rows(); ++i) {
        const auto exact = exact_base({r, t}, nu, rough, points(i, 0));
        EXPECT_NEAR(-found(i, 1), exact.pressure, 5e-4) << r << " " << t << " " << rough;
        // y up: the shear of x and depth changes sign.
        EXPECT_NEAR(-found(i, 2), exact.shear, 5e-4) << r << " " << t << " " << rough;
      }
      EXPECT_NEAR(model->figures().at("r"), r, 1e-12);
      EXPECT_NEAR(model->figures().at("t"), t, 1e-12);
    }
  }
}

TEST(FeOrthotropicLayer, BearsTheLoadAndShowsOnePeakOrTwo) {
  for (const auto& [r, t, base, peaks] : {std::tuple{1., 1., "smooth", 1},
                                          {0.2, 0.5, "rough", 1},
                                          {-0.7, 1., "smooth", 2},
                                          {-0.7, 1., "rough", 2}}) {
    const auto model = make_model(
        "fe_orthotropic_layer",
        {{"r", text_of(r)}, {"t", text_of(t)}, {"base", base}, {"nu_xy", r < 0 ? "0.8" : "0.3"}});
    const int n = 1601;
    const Points points = along(1, -8, 8, n);
    const Eigen::VectorXd pressure = -model->stress(points).col(1);
    EXPECT_NEAR(pressure.sum() * 16 / (n - 1), 1, 1e-3) << r;
    int found = 0;
    for (int i = 1; i < n - 1; ++i)
      found += pressure[i] > 0.1 && pressure[i] > pressure[i - 1] && pressure[i] >= pressure[i + 1];
    EXPECT_EQ(found, peaks) << r << " " << base;
  }
}

// At r = 0.05 the top of the pressure is dented on a rough base only.
TEST(FeOrthotropicLayer, TheBaseChoosesTheNumberOfPeaks) {
  for (const bool rough : {false, true}) {
    const auto model =
        make_model("fe_orthotropic_layer",
                   {{"r", "0.05"}, {"nu_xy", "0.95"}, {"base", rough ? "rough" : "smooth"}});
    const Eigen::VectorXd pressure = -model->stress(along(1, 0, 0.28, 2)).col(1);
    const double rise = exact_base({0.05, 1}, 0.95, rough, 0.28).pressure -
                        exact_base({0.05, 1}, 0.95, rough, 0).pressure;
    EXPECT_NEAR(pressure[1] - pressure[0], rise, 5e-4) << rough;
    EXPECT_GT(rough ? rise : -rise, 2e-3) << rough;
  }
}

TEST(FeOrthotropicLayer, MapThatIsMirroredMirrorsTheStress) {
  const auto young = [](double x, double y) {
    return text_of(1 + 0.2 * x / 4 - 0.5 * y) + "," + text_of(0.3 + 0.02 * x);
  };
  const Points points = along(1, -2, 2, 9);
  const char* base = "rough";
  {
    Stresses there, back;
    {
      const Map map("young,poisson", young);
      there =
          make_model("fe_orthotropic_layer", {{"base", base}, {"map", map.file()}})->stress(points);
    }
    {
      const Map map("young,poisson", [&](double x, double y) { return young(-x, y); });
      back =
          make_model("fe_orthotropic_layer", {{"base", base}, {"map", map.file()}})->stress(points);
    }
    EXPECT_GT((there - there.colwise().reverse()).cwiseAbs().maxCoeff(), 5e-3);
    Stresses mirrored = back.colwise().reverse();
    mirrored.col(2) *= -1;
    EXPECT_LT((there - mirrored).cwiseAbs().maxCoeff(), 1e-5);
    // What a map changes, it only moves.
    const Points base_points = along(1, -8, 8, 801);
    const Map map("young,poisson", young);
    const Eigen::VectorXd pressure =
        -make_model("fe_orthotropic_layer", {{"base", base}, {"map", map.file()}})
             ->stress(base_points)
             .col(1);
    EXPECT_NEAR(pressure.sum() * 16 / 800, 1, 1e-3);
  }
}
