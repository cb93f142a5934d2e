// A point load on a transversely isotropic half space: balance, the surface, the load, isotropy,
// and a line of point loads against the plane's closed form.
#include "continuum/closed/transverse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>

#include "continuum/closed/half_space.h"
#include "continuum/closed/orthotropic.h"
#include "continuum/model.h"
#include "dem/random/random.h"

namespace grainfield::continuum {
namespace {

using dem::Random;
using ::testing::HasSubstr;
using Rule = boost::math::quadrature::gauss_kronrod<double, 61>;

// Moduli over three decades; roots real and conjugate, nearly equal ones among them.
TransverseModuli random_moduli(Random& random) {
  for (;;) {
    TransverseModuli m;
    m.E_h = std::exp(random.uniform(-3, 3));
    m.nu_h = random.uniform(-0.5, 0.9);
    m.nu_v = random.uniform(-0.3, 0.8);
    m.G_v = std::exp(random.uniform(-3, 2));
    if (m.is_stable()) return m;
  }
}

TEST(TransverseHalfSpace, IsBoussinesqsWhereItIsIsotropic) {
  Random random(1);
  for (int k = 0; k < 2000; ++k) {
    const double nu = random.uniform(-0.5, 0.49), E = random.uniform(1, 9);
    const TransverseHalfSpace half(2, {E, E, nu, nu, E / (2 * (1 + nu))});
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = -random.uniform(0.05, 1);
    const auto found = half.stress(x, y, z), exact = boussinesq_stress(2.0, nu, x, y, z);
    const double size = 2 / (x * x + y * y + z * z);
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(found[c], exact[c], 1e-9 * size) << c;
  }
}

TEST(TransverseHalfSpace, IsInBalanceAndItsSurfaceIsFree) {
  Random random(2);
  const int index[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  for (int trial = 0; trial < 2000; ++trial) {
    const TransverseHalfSpace half(1, random_moduli(random));
    const Eigen::Vector3d at(random.uniform(-1, 1), random.uniform(-1, 1), -random.uniform(0.1, 1));
    constexpr double kStep = 1e-4;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double size = 0;
    for (int j = 0; j < 3; ++j) {
      const auto along = [&](double way) {
        Eigen::Vector3d p = at;
        p[j] += way * kStep;
        return half.stress(p.x(), p.y(), p.z());
      };
      const auto a = along(1), b = along(-1), c = along(2), d = along(-2);
      for (int i = 0; i < 3; ++i) {
        const auto n = static_cast<std::size_t>(index[i][j]);
        const double slope = (8 * (a[n] - b[n]) - (c[n] - d[n])) / (12 * kStep);
        sum[i] += slope;
        size = std::max(size, std::fabs(slope));
      }
    }
    EXPECT_LT(sum.norm(), 1e-5 * size);
    const auto near = half.stress(at.x(), at.y(), -1e-9);
    for (const std::size_t c : {2u, 3u, 4u}) EXPECT_NEAR(near[c], 0, 1e-5 * std::fabs(near[0]));
  }
}

// Its displacement: Hooke's law of the strains by differences, and Boussinesq's where isotropic.
TEST(TransverseHalfSpace, TheStressIsHookesOfTheDisplacement) {
  Random random(6);
  for (int trial = 0; trial < 500; ++trial) {
    const TransverseModuli m = random_moduli(random);
    const TransverseHalfSpace half(1, m);
    const Eigen::Vector3d at(random.uniform(-1, 1), random.uniform(-1, 1), -random.uniform(0.1, 1));
    constexpr double kStep = 1e-4;
    Eigen::Matrix3d gradient;
    for (int j = 0; j < 3; ++j) {
      const auto along = [&](double way) {
        Eigen::Vector3d p = at;
        p[j] += way * kStep;
        const auto u = half.displacement(p.x(), p.y(), p.z());
        return Eigen::Vector3d(u[0], u[1], u[2]);
      };
      gradient.col(j) = (8 * (along(1) - along(-1)) - (along(2) - along(-2))) / (12 * kStep);
    }
    Eigen::Matrix<double, 6, 1> strain;
    strain << gradient(0, 0), gradient(1, 1), gradient(2, 2), gradient(1, 2) + gradient(2, 1),
        gradient(0, 2) + gradient(2, 0), gradient(0, 1) + gradient(1, 0);
    const Eigen::Matrix<double, 6, 1> stress = m.stiffness() * strain;
    const auto exact = half.stress(at.x(), at.y(), at.z());
    const double size = m.stiffness().norm() * strain.norm();
    for (int c = 0; c < 6; ++c)
      EXPECT_NEAR(stress[c], exact[static_cast<std::size_t>(c)], 1e-6 * size) << c;
  }
  const TransverseHalfSpace half(2, {5, 5, 0.3, 0.3, 5 / 2.6});
  const auto found = half.displacement(0.3, -0.4, -0.6);
  const auto exact = boussinesq_displacement(2, 5, 0.3, 0.3, -0.4, -0.6);
  for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(found[d], exact[d], 1e-9);
}

TEST(TransverseHalfSpace, EveryDepthCarriesTheLoad) {
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const TransverseHalfSpace half(3, random_moduli(random));
    // r = tan: the whole plane.
    const auto ring = [&](double angle) {
      const double r = std::tan(angle), c = std::cos(angle);
      return -half.stress(r, 0, -1)[2] * 2 * std::numbers::pi * r / (c * c);
    };
    EXPECT_NEAR(Rule::integrate(ring, 0.0, std::numbers::pi / 2, 12), 3, 1e-6);
  }
}

// Loads along y are a line load in plane strain, whose half plane is known (orthotropic.h).
TEST(TransverseHalfSpace, ALineOfThemIsTheOrthotropicHalfPlane) {
  Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const TransverseModuli m = random_moduli(random);
    const TransverseHalfSpace half(1, m);
    // Compliances of plane strain: eps_yy = 0.
    const double s_xx = (1 - m.nu_h * m.nu_h) / m.E_h;
    const double s_zz = 1 / m.E_v - m.nu_v * m.nu_v * m.E_h / (m.E_v * m.E_v);
    const double s_xz = -m.nu_v * (1 + m.nu_h) / m.E_v;
    const Orthotropy plane = orthotropy(1 / s_xx, 1 / s_zz, -s_xz / s_xx, m.G_v);
    const double x = random.uniform(-1, 1), z = -random.uniform(0.2, 1);
    const auto exact = orthotropic_stress(1, plane, x, z);
    const double size = std::fabs(exact[0]) + std::fabs(exact[1]) + std::fabs(exact[2]);
    const std::size_t components[3] = {0, 2, 4};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto loads = [&](double angle) {
        const double cosine = std::cos(angle);
        return half.stress(x, std::tan(angle), z)[components[c]] / (cosine * cosine);
      };
      const double sum = 2 * Rule::integrate(loads, 0.0, std::numbers::pi / 2, 12);
      EXPECT_NEAR(sum, exact[c], 1e-6 * size) << c << " r " << plane.r << " t " << plane.t;
    }
  }
}

// c13 = -c44 of a material that widens as it is stretched: the potentials' own equation is 0/0.
TEST(TransverseHalfSpace, IsContinuousWhereItsShearAndCouplingCancel) {
  TransverseModuli m{1, 1.5, 0.2, -0.3, 0};
  // c13 = nu_v E_h E_v/((1 - nu_h) E_v - 2 nu_v^2 E_h)
  m.G_v = -m.nu_v * m.E_h * m.E_v / ((1 - m.nu_h) * m.E_v - 2 * m.nu_v * m.nu_v * m.E_h);
  TransverseModuli near = m;
  near.G_v *= 1 + 1e-6;
  const auto at = TransverseHalfSpace(1, m).stress(0.3, -0.2, -0.7);
  const auto beside = TransverseHalfSpace(1, near).stress(0.3, -0.2, -0.7);
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(at[c], beside[c], 1e-5) << c;
}

TEST(TransverseHalfSpace, ItsAxisIsSmoothAndItsSettingsAreChecked) {
  const auto model = make_model("transverse_half_space", {{"E_h", "0.5"}, {"nu_v", "0.2"}});
  Eigen::MatrixXd points(3, 3);
  points << 0, 0, -1, 1e-7, 0, -1, 0, 0, 0.1;
  const Stresses s = model->stress(points);
  EXPECT_NEAR(s(0, 0), s(1, 0), 1e-9);
  EXPECT_NEAR(s(0, 0), s(0, 1), 1e-12);
  EXPECT_TRUE(s.row(2).array().isNaN().all());
  try {
    make_model("transverse_half_space", {{"E_h", "9"}, {"nu_v", "0.4"}});
    FAIL();
  } catch (const BadParameter& e) {
    EXPECT_THAT(e.what(), HasSubstr("2 nu_v^2 E_h/E_v below 1 - nu_h"));
  }
}

}  // namespace
}  // namespace grainfield::continuum
