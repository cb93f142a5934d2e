// Line load on an orthotropic half plane: balance, compatibility, limits, one peak and two.
#include "continuum/closed/orthotropic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <complex>

#include "continuum/closed/half_space.h"
#include "continuum/model.h"
#include "dem/random/random.h"
#include "tests/continuum/refused_model.h"

using namespace grainfield::continuum;
using grainfield::dem::Random;
using ::testing::HasSubstr;

namespace {

std::string refusal(const Settings& settings) {
  return grainfield::continuum::refusal("orthotropic_half_plane", settings);
}

Orthotropy random_medium(Random& random) {
  Orthotropy out;
  out.t = std::exp(random.uniform(-2, 2));
  out.r = -0.98 * std::sqrt(out.t) + std::exp(random.uniform(-4, 2));
  return out;
}

// Derivatives along x and y by complex steps.
std::array<double, 3> derivative(const Orthotropy& o, double x, double y, int axis) {
  using C = std::complex<double>;
  const double h = 1e-30;
  const auto s = orthotropic_stress<C>(1, o, {x, axis == 0 ? h : 0}, {y, axis == 1 ? h : 0});
  return {s[0].imag() / h, s[1].imag() / h, s[2].imag() / h};
}

}  // namespace

TEST(Orthotropic, IsInEquilibrium) {
  Random random(1);
  for (int k = 0; k < 5000; ++k) {
    const Orthotropy o = random_medium(random);
    const double x = random.uniform(-2, 2), y = -random.uniform(0.1, 2);
    const auto dx = derivative(o, x, y, 0), dy = derivative(o, x, y, 1);
    double size = 0;
    for (const auto& d : {dx, dy})
      for (const double v : d) size = std::max(size, std::fabs(v));
    EXPECT_NEAR(dx[0] + dy[2], 0, 1e-12 * size);
    EXPECT_NEAR(dx[2] + dy[1], 0, 1e-12 * size);
  }
}

// Strains of Hooke's law for random elastic constants fit together: Richardson's second differences
// of eps_xx,yy + eps_yy,xx - 2 eps_xy,xy.
TEST(Orthotropic, StrainsAreCompatible) {
  Random random(2);
  for (int k = 0; k < 500; ++k) {
    const double E_x = std::exp(random.uniform(-1, 1)), E_y = std::exp(random.uniform(-1, 1)),
                 nu = random.uniform(-0.3, 0.3), G = std::exp(random.uniform(-1, 0));
    const Orthotropy o = orthotropy(E_x, E_y, nu, G);
    const double x0 = random.uniform(-1, 1), y0 = -1;
    const auto strain = [&](double x, double y) {
      const auto s = orthotropic_stress(1, o, x, y);
      return std::array<double, 3>{(s[0] - nu * s[1]) / E_x, s[1] / E_y - nu * s[0] / E_x,
                                   s[2] / G};
    };
    const auto incompatible = [&](double h) {
      const auto c = strain(x0, y0);
      const double xx = strain(x0, y0 + h)[0] - 2 * c[0] + strain(x0, y0 - h)[0],
                   yy = strain(x0 + h, y0)[1] - 2 * c[1] + strain(x0 - h, y0)[1],
                   xy = (strain(x0 + h, y0 + h)[2] - strain(x0 - h, y0 + h)[2] -
                         strain(x0 + h, y0 - h)[2] + strain(x0 - h, y0 - h)[2]) /
                        4;
      return std::array<double, 2>{(xx + yy - xy) / (h * h),
                                   (std::fabs(xx) + std::fabs(yy) + std::fabs(xy)) / (h * h)};
    };
    const auto coarse = incompatible(4e-3), fine = incompatible(2e-3);
    EXPECT_NEAR((4 * fine[0] - coarse[0]) / 3, 0, 2e-5 * (1 + fine[1])) << k;
  }
}

TEST(Orthotropic, BearsTheLoadAtEveryDepth) {
  Random random(3);
  for (int k = 0; k < 200; ++k) {
    const Orthotropy o = random_medium(random);
    // x = tan(angle): the tail falls off as x^-4.
    const int n = 20000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double angle = M_PI * ((i + 0.5) / n - 0.5), x = std::tan(angle);
      sum -= orthotropic_stress(7, o, x, -1.)[1] * (1 + x * x) * M_PI / n;
    }
    EXPECT_NEAR(sum, 7, 1e-8) << o.r << " " << o.t;
  }
}

TEST(Orthotropic, IsotropicIsFlamant) {
  Random random(4);
  const Orthotropy o = orthotropy(3, 3, 0.2, 3 / (2 * 1.2));
  EXPECT_NEAR(o.r, 1, 1e-15);
  EXPECT_EQ(o.t, 1);
  for (int k = 0; k < 1000; ++k) {
    const double x = random.uniform(-2, 2), y = -random.uniform(0.01, 2);
    const auto a = orthotropic_stress(2, {1, 1}, x, y), b = flamant_stress(2, x, y);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-12 * (1 + std::fabs(b[1])));
  }
}

TEST(Orthotropic, OnePeakOrTwo) {
  Random random(5);
  for (int k = 0; k < 500; ++k) {
    const Orthotropy o = random_medium(random);
    int peaks = 0;
    double at = 0;
    const auto pressure = [&](double x) { return -orthotropic_stress(1, o, x, -1.)[1]; };
    const double step = 2e-3;
    for (double x = -5; x < 5; x += step) {
      if (pressure(x) > pressure(x - step) && pressure(x) > pressure(x + step)) {
        ++peaks;
        at = std::fabs(x);
      }
    }
    if (std::fabs(o.r) < 1e-4) continue;  // too flat for the step
    EXPECT_EQ(peaks, o.r < 0 ? 2 : 1) << o.r << " " << o.t;
    EXPECT_NEAR(at, o.r < 0 ? std::sqrt(-o.r) : 0, 2 * step);
  }
}

// Towards r = -sqrt(t): half the load in each of two peaks on the characteristics of an OSL
// material with eta = sqrt(t), which narrow in proportion to sqrt(r + sqrt(t)).
TEST(Orthotropic, SharpensIntoTwoCharacteristics) {
  const double t = 0.49, foot = std::pow(t, 0.25);
  double before = 0;
  for (const double epsilon : {1e-4, 1e-6, 1e-8}) {
    const auto pressure = [&](double x) {
      return -orthotropic_stress(1, {-std::sqrt(t) + epsilon, t}, x, -1.)[1];
    };
    double outside = 0, inside = 0;
    const double reach = 0.05;
    const int n = 400000;
    for (int i = 0; i < n; ++i) {
      const double x = foot + reach * (2 * (i + 0.5) / n - 1);
      inside += pressure(x) * 2 * reach / n;
    }
    outside = 0.5 - inside;
    if (before > 0) {
      EXPECT_NEAR(before / outside, 10, 1);
    }
    before = outside;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(Orthotropic, SettingsAndFigures) {
  const auto by_ratio =
      make_model("orthotropic_half_plane", {{"r", "-0.4"}, {"t", "0.5"}, {"F", "3"}});
  EXPECT_EQ(by_ratio->figures().at("peaks"), 2);
  EXPECT_NEAR(by_ratio->figures().at("peak_at_over_depth"), std::sqrt(0.4), 1e-15);
  // r = (E_x/G - 2 nu)/2 = -0.4: E_x/G = 0.2 - 0.8 + ... with nu = 0.5, E_x = 1, G = 5.
  const auto by_moduli =
      make_model("orthotropic_half_plane",
                 {{"E_x", "1"}, {"E_y", "2"}, {"G", "5"}, {"nu_xy", "0.5"}, {"F", "3"}});
  Points p(3, 2);
  p << 0.2, -1, -0.5, -0.3, 0, 0.1;
  const Stresses a = by_ratio->stress(p), b = by_moduli->stress(p);
  EXPECT_LT((a - b).topRows(2).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_TRUE(a.row(2).array().isNaN().all());
}

TEST(Orthotropic, RefusesWhatCannotBe) {
  EXPECT_THAT(refusal({{"r", "-1"}}),
              HasSubstr("r = -1 is not elastic; allowed: above -sqrt(t) = -1 at t = 1"));
  EXPECT_THAT(refusal({{"t", "0"}}), HasSubstr("t = 0 is out of range; allowed: above 0"));
  EXPECT_THAT(refusal({{"E_x", "1"}, {"G", "1"}}),
              HasSubstr("found 2 of E_x, E_y, G; allowed: all three, with nu_xy, or none"));
}

// Strain of the displacement, by Richardson's differences, against Hooke's law, random media.
TEST(Orthotropic, DisplacementHasTheStrainsOfTheStress) {
  Random random(6);
  for (int k = 0; k < 300; ++k) {
    const Orthotropy o = random_medium(random);
    const double least = std::max(-o.r, -std::sqrt(o.t));
    PlaneModuli m;
    m.nu_xy = least + random.uniform(0.05, 0.95) * (std::sqrt(o.t) - least);
    m.E_x = std::exp(random.uniform(-1, 1));
    m.E_y = m.E_x / o.t;
    m.G = m.E_x / (2 * (o.r + m.nu_xy));
    ASSERT_TRUE(is_stable(m));
    const double x = random.uniform(-2, 2), y = -random.uniform(0.05, 2);
    const auto difference = [&](int axis, double h) -> Eigen::Vector2d {
      const double dx = axis == 0 ? h : 0, dy = axis == 1 ? h : 0;
      const auto a = orthotropic_displacement(3, m, x + dx, y + dy),
                 b = orthotropic_displacement(3, m, x - dx, y - dy);
      return Eigen::Vector2d(a[0] - b[0], a[1] - b[1]) / (2 * h);
    };
    const auto derivative_of_u = [&](int axis) -> Eigen::Vector2d {
      const double h =
          2e-3 * std::fabs(y) * std::sqrt(o.r + std::sqrt(o.t)) / (1 + std::fabs(x / y));
      return (4 * difference(axis, h / 2) - difference(axis, h)) / 3;
    };
    const Eigen::Vector2d ux = derivative_of_u(0), uy = derivative_of_u(1);
    const auto stress = orthotropic_stress(3, o, x, y);
    const Eigen::Vector3d strain = compliance(m) * Eigen::Vector3d(stress[0], stress[1], stress[2]);
    const double size = strain.cwiseAbs().maxCoeff() + std::fabs(ux[1]) + std::fabs(uy[0]);
    EXPECT_NEAR(ux[0], strain[0], 1e-6 * size) << k;
    EXPECT_NEAR(uy[1], strain[1], 1e-6 * size) << k;
    EXPECT_NEAR(ux[1] + uy[0], strain[2], 1e-6 * size) << k;
  }
}

TEST(Orthotropic, IsotropicDisplacementIsFlamants) {
  Random random(7);
  for (int k = 0; k < 300; ++k) {
    const double nu = random.uniform(0, 0.49), E = 2;
    const double x = random.uniform(-2, 2), y = -random.uniform(0, 2);
    const auto a = orthotropic_displacement(3, plane_strain_moduli(E, nu), x, y);
    const auto b = flamant_displacement(3, E, nu, x, y);
    EXPECT_NEAR(a[0], b[0], 1e-10);
    EXPECT_NEAR(a[1], b[1], 1e-10);
  }
}
