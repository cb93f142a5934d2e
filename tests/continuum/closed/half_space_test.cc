// Flamant and Boussinesq: equilibrium by complex step, total load, displacement against stress.
#include "continuum/closed/half_space.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <complex>
#include <random>

#include "continuum/model.h"

using namespace grainfield::continuum;
using Complex = std::complex<double>;

namespace {

constexpr double kStep = 1e-30;  // of the complex step: no cancellation, so as small as it gets
const Complex kI(0, kStep);

}  // namespace

TEST(HalfSpace, FlamantIsInEquilibriumAndCompatible) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int sample = 0; sample < 1000; ++sample) {
    const double x = any(random), y = -0.05 - std::abs(any(random));
    const auto dx = flamant_stress<Complex>(1, x + kI, y);
    const auto dy = flamant_stress<Complex>(1, x, y + kI);
    const double scale = kStep / (x * x + y * y);
    EXPECT_NEAR((dx[0] + dy[2]).imag() / scale, 0, 1e-12);
    EXPECT_NEAR((dx[2] + dy[1]).imag() / scale, 0, 1e-12);
  }
}

TEST(HalfSpace, FlamantDisplacementGivesItsStress) {
  const double E = 7, nu = 0.27, G = E / (2 * (1 + nu)), lambda = 2 * G * nu / (1 - 2 * nu);
  for (const double x : {-0.8, -0.1, 0., 0.4}) {
    const double y = -0.5, e = 1e-4;
    const auto px = flamant_displacement(2, E, nu, x + e, y);
    const auto mx = flamant_displacement(2, E, nu, x - e, y);
    const auto py = flamant_displacement(2, E, nu, x, y + e);
    const auto my = flamant_displacement(2, E, nu, x, y - e);
    const double xx = (px[0] - mx[0]) / (2 * e), yy = (py[1] - my[1]) / (2 * e);
    const double twice_xy = (px[1] - mx[1] + py[0] - my[0]) / (2 * e);
    const auto s = flamant_stress(2., x, y);
    EXPECT_NEAR(s[0], lambda * (xx + yy) + 2 * G * xx, 1e-6);
    EXPECT_NEAR(s[1], lambda * (xx + yy) + 2 * G * yy, 1e-6);
    EXPECT_NEAR(s[2], G * twice_xy, 1e-6);
  }
}

TEST(HalfSpace, BoussinesqIsInEquilibriumForEveryPoissonRatio) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int sample = 0; sample < 1000; ++sample) {
    const double nu = 0.25 * (1 + any(random));
    const double x = any(random), y = any(random), z = -0.02 - std::abs(any(random));
    const auto dx = boussinesq_stress<Complex>(1, nu, x + kI, y, z);
    const auto dy = boussinesq_stress<Complex>(1, nu, x, y + kI, z);
    const auto dz = boussinesq_stress<Complex>(1, nu, x, y, z + kI);
    const double scale = kStep / std::pow(x * x + y * y + z * z, 1.5);
    EXPECT_NEAR((dx[0] + dy[5] + dz[4]).imag() / scale, 0, 1e-12);
    EXPECT_NEAR((dx[5] + dy[1] + dz[3]).imag() / scale, 0, 1e-12);
    EXPECT_NEAR((dx[4] + dy[3] + dz[2]).imag() / scale, 0, 1e-12);
  }
}

TEST(HalfSpace, BoussinesqDisplacementGivesItsStress) {
  const double E = 7, nu = 0.2, G = E / (2 * (1 + nu)), lambda = 2 * G * nu / (1 - 2 * nu);
  const double e = 1e-4, p[3] = {0.3, -0.2, -0.5};
  Eigen::Matrix3d gradient;
  for (int j = 0; j < 3; ++j) {
    double plus[3] = {p[0], p[1], p[2]}, minus[3] = {p[0], p[1], p[2]};
    plus[j] += e;
    minus[j] -= e;
    const auto a = boussinesq_displacement(2, E, nu, plus[0], plus[1], plus[2]);
    const auto b = boussinesq_displacement(2, E, nu, minus[0], minus[1], minus[2]);
    for (int i = 0; i < 3; ++i) gradient(i, j) = (a[i] - b[i]) / (2 * e);
  }
  const Eigen::Matrix3d stress = lambda * gradient.trace() * Eigen::Matrix3d::Identity() +
                                 G * (gradient + gradient.transpose());
  const auto s = boussinesq_stress(2., nu, p[0], p[1], p[2]);
  const double expected[6] = {stress(0, 0), stress(1, 1), stress(2, 2),
                              stress(1, 2), stress(0, 2), stress(0, 1)};
  for (int c = 0; c < 6; ++c) EXPECT_NEAR(s[c], expected[c], 1e-6) << c;
}

TEST(HalfSpace, PlanesCarryTheLoad) {
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
  const double infinity = std::numeric_limits<double>::infinity();
  const double plane = Quadrature::integrate(
      [](double r) { return -2 * M_PI * r * boussinesq_stress(1., 0.3, r, 0., -0.7)[2]; }, 0.,
      infinity, 15, 1e-11);
  EXPECT_NEAR(plane, 1, 1e-8);
  const double line = Quadrature::integrate(
      [](double x) { return -flamant_stress(1., x, -0.7)[1]; }, -infinity, infinity, 15, 1e-11);
  EXPECT_NEAR(line, 1, 1e-8);
}

TEST(HalfSpace, BoussinesqTurnsWithTheAxes) {
  // The xx component on the x axis is the yy component on the y axis; on the vertical both agree.
  const auto a = boussinesq_stress(1., 0.2, 0.4, 0., -0.3);
  const auto b = boussinesq_stress(1., 0.2, 0., 0.4, -0.3);
  EXPECT_DOUBLE_EQ(a[0], b[1]);
  EXPECT_DOUBLE_EQ(a[4], b[3]);
  const auto c = boussinesq_stress(1., 0.2, 0., 0., -0.5);
  EXPECT_DOUBLE_EQ(c[0], c[1]);
  EXPECT_NEAR(c[0], (1 - 2 * 0.2) / (4 * M_PI * 0.25), 1e-14);
}

TEST(HalfSpace, ModelsReturnNanOutside) {
  const auto flamant = make_model("flamant", {{"F", "2"}});
  const auto out = flamant->stress((Points(3, 2) << 0, -1, 1, 0, 0, 0.5).finished());
  EXPECT_NEAR(out(0, 1), -4 / M_PI, 1e-14);
  EXPECT_TRUE(out.bottomRows(2).array().isNaN().all());
  const auto boussinesq = make_model("boussinesq", {});
  const auto out3 = boussinesq->stress((Points(2, 3) << 0, 0, -1, 1, 0, 0).finished());
  EXPECT_NEAR(out3(0, 2), -3 / (2 * M_PI), 1e-14);
  EXPECT_TRUE(out3.row(1).array().isNaN().all());
}

TEST(Hydrostatic, PressureBelowTheSurface) {
  const auto model = make_model("hydrostatic", {{"rho_g", "10"}, {"level", "2"}});
  const auto out = model->stress((Points(2, 2) << 3, -1, 0, 2.5).finished());
  EXPECT_EQ(out.row(0), Eigen::RowVector3d(-30, -30, 0));
  EXPECT_TRUE(out.row(1).array().isNaN().all());
}

TEST(Hydrostatic, UnderTheFlanksOfAHeap) {
  const auto model =
      make_model("hydrostatic", {{"rho_g", "10"}, {"left_deg", "45"}, {"right_deg", "30"}});
  const auto out = model->stress((Points(4, 2) << 0, -1, -0.5, -1, 0.5, -1, -1, -0.9).finished());
  EXPECT_EQ(out.row(0), Eigen::RowVector3d(-10, -10, 0));
  EXPECT_NEAR(out(1, 1), -5, 1e-12);
  EXPECT_NEAR(out(2, 0), -10 * (1 - 0.5 / std::sqrt(3.0)), 1e-12);
  EXPECT_TRUE(out.row(3).array().isNaN().all());
  EXPECT_THROW(make_model("hydrostatic", {{"left_deg", "90"}}), std::invalid_argument);
}
