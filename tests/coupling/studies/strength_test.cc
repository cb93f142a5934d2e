// Friction and dilation angles of paths whose angles are known.
#include "coupling/studies/sample/strength.h"

#include <gmock/gmock.h>

#include <cmath>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

using Eigen::VectorXd;

// States at equal steps of strain up to 0.2; friction rises to its peak at 0.05 and falls to the
// residual at 0.1; dilation likewise. `states`: after the first one.
StrengthPath path_of(StrengthTest test, double peak_deg, double residual_deg, double dilation_deg,
                     int states = 40) {
  StrengthPath path;
  path.test = test;
  const int n = states + 1;
  path.strain = VectorXd::LinSpaced(n, 0, 0.2);
  path.volumetric = path.driving = path.holding = VectorXd::Zero(n);
  path.bears.assign(static_cast<std::size_t>(n), true);
  const auto angle_at = [&](double e, double peak, double end) {
    if (e <= 0.05) return peak * e / 0.05;
    return e >= 0.1 ? end : peak + (end - peak) * (e - 0.05) / 0.05;
  };
  for (int k = 0; k < n; ++k) {
    const double e = path.strain[k];
    const double phi = angle_at(e, peak_deg, residual_deg) * kDegree;
    path.holding[k] = 100;
    path.driving[k] = test == StrengthTest::shear ? 100 * std::tan(phi)
                                                  : 100 * (1 + std::sin(phi)) / (1 - std::sin(phi));
    // Constant dilation up to 0.1, none after.
    const double s = std::sin(dilation_deg * kDegree);
    const double slope =
        test == StrengthTest::shear ? std::tan(dilation_deg * kDegree) : 2 * s / (1 - s);
    path.volumetric[k] = slope * std::min(e, 0.1);
  }
  return path;
}

TEST(Strength, OfKnownPaths) {
  for (const StrengthTest test : {StrengthTest::axial, StrengthTest::shear}) {
    for (const auto& [peak, residual, dilation] :
         {std::tuple(38.0, 30.0, 9.0), {25.0, 25.0, 0.0}, {45.0, 20.0, 15.0}}) {
      const Strength s = strength_of(path_of(test, peak, residual, dilation));
      EXPECT_NEAR(s.peak_friction, peak, 1e-9);
      EXPECT_NEAR(s.strain_at_peak, 0.05, peak == residual ? 0.2 : 1e-12);
      EXPECT_NEAR(s.residual_friction, residual, 1e-9);
      EXPECT_NEAR(s.peak_dilation, dilation, 1e-9);
      if (peak != residual) {
        EXPECT_NEAR(s.dilation_at_peak, dilation, 1e-9);
      }
      EXPECT_NEAR(s.residual_dilation, 0, 1e-9);
    }
  }
}

TEST(Strength, OfFewStatesAndOfStatesThatBearNothing) {
  StrengthPath path = path_of(StrengthTest::axial, 38, 30, 9, 4);
  EXPECT_NEAR(strength_of(path).peak_friction, 38, 1e-9);
  EXPECT_NEAR(strength_of(path).residual_friction, 30, 1e-9);
  // Where strength is lost there is no residual; the peak is that of what still bears.
  path = path_of(StrengthTest::axial, 38, 30, 9);
  for (std::size_t k = 5; k < path.bears.size(); ++k) path.bears[k] = false;
  EXPECT_TRUE(std::isnan(strength_of(path).residual_friction));
  EXPECT_NEAR(strength_of(path).peak_friction, 38 * 0.02 / 0.05, 1e-9);
  path.bears.assign(path.bears.size(), false);
  EXPECT_TRUE(std::isnan(strength_of(path).peak_friction));
  // A volume that is held tells no dilation.
  path = path_of(StrengthTest::shear, 38, 30, 9);
  path.volumetric.resize(0);
  EXPECT_TRUE(std::isnan(strength_of(path).peak_dilation));
  EXPECT_NEAR(strength_of(path).residual_friction, 30, 1e-9);
}

TEST(Strength, FiguresAreThereWhereAllRealizationsTellThem) {
  StrengthPath held = path_of(StrengthTest::shear, 38, 30, 9);
  const auto both = strength_figures({held, path_of(StrengthTest::shear, 36, 28, 5)});
  EXPECT_THAT(
      both.at("strength.peak_friction_deg"),
      ::testing::ElementsAre(::testing::DoubleNear(38, 1e-9), ::testing::DoubleNear(36, 1e-9)));
  held.volumetric.resize(0);
  const auto one = strength_figures({held, path_of(StrengthTest::shear, 36, 28, 5)});
  EXPECT_EQ(one.count("strength.peak_dilation_deg"), 0U);
  EXPECT_EQ(one.count("strength.residual_friction_deg"), 1U);
}

}  // namespace
}  // namespace grainfield::coupling
