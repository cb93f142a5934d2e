// Elastic constants in space from known materials; the test of symmetry: how often it refuses what
// holds, and whether it refuses what does not.
#include "coupling/elastic_constants/space_symmetry.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace grainfield::coupling {
namespace {

using Eigen::Matrix3d;
using Six = Eigen::Matrix<double, 6, 1>;
using Stiffness = Eigen::Matrix<double, 6, 6>;

// The stress of strains xx, yy, zz, and twice yz, xz, xy.
Matrix3d stress_of(const Stiffness& c, const Matrix3d& e) {
  Six v;
  v << e(0, 0), e(1, 1), e(2, 2), 2 * e(1, 2), 2 * e(0, 2), 2 * e(0, 1);
  const Six s = c * v;
  Matrix3d out;
  out << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return out;
}

// From engineering constants: a compliance, inverted.
Stiffness transverse(double e_h, double e_v, double nu_h, double nu_vh, double g_vh) {
  Stiffness s = Stiffness::Zero();
  s(0, 0) = s(1, 1) = 1 / e_h;
  s(2, 2) = 1 / e_v;
  s(0, 1) = s(1, 0) = -nu_h / e_h;
  s(0, 2) = s(2, 0) = s(1, 2) = s(2, 1) = -nu_vh / e_v;
  s(3, 3) = s(4, 4) = 1 / g_vh;
  s(5, 5) = 2 * (1 + nu_h) / e_h;
  return s.inverse();
}

Stiffness isotropic(double young, double nu) {
  return transverse(young, young, nu, nu, young / (2 * (1 + nu)));
}

std::vector<Matrix3d> probes(bool shears) {
  std::vector<Matrix3d> out;
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      if (a != b && !shears) continue;
      Matrix3d e = Matrix3d::Zero();
      e(a, b) = e(b, a) = 1e-5;
      out.push_back(e);
    }
  }
  return out;
}

SpaceIncrements increments(const Stiffness& c, bool shears = true) {
  SpaceIncrements out;
  for (const Matrix3d& e : probes(shears)) out.push_back({stress_of(c, e), e});
  return out;
}

TEST(SpaceModuli, AreFoundAgain) {
  const SpaceModuli iso = space_moduli(increments(isotropic(3e6, 0.2)));
  EXPECT_NEAR(iso.young, 3e6, 1);
  EXPECT_NEAR(iso.poisson, 0.2, 1e-9);
  EXPECT_NEAR(iso.bulk, 3e6 / (3 * (1 - 0.4)), 1);
  EXPECT_NEAR(iso.shear, 3e6 / 2.4, 1);
  EXPECT_LT(iso.residual_isotropic, 1e-12);
  for (const bool shears : {true, false}) {
    const SpaceModuli m = space_moduli(increments(transverse(2e6, 3e6, 0.1, 0.25, 9e5), shears));
    EXPECT_NEAR(m.e_h, 2e6, 1);
    EXPECT_NEAR(m.e_v, 3e6, 1);
    EXPECT_NEAR(m.nu_h, 0.1, 1e-9);
    EXPECT_NEAR(m.nu_vh, 0.25, 1e-9);
    EXPECT_EQ(std::isnan(m.g_vh), !shears);
    if (shears) {
      EXPECT_NEAR(m.g_vh, 9e5, 1);
    }
    EXPECT_LT(m.residual_transverse, 1e-12);
    EXPECT_GT(m.residual_isotropic, 0.05);
  }
}

TEST(SpaceModuli, OneProbeTellsNoConstants) {
  const SpaceIncrements all = increments(isotropic(1, 0.2));
  const SpaceModuli m = space_moduli({all[0]});
  EXPECT_TRUE(std::isnan(m.e_v));
  EXPECT_NEAR(m.young, 1, 1e-9);  // an axial strain tells K and G
}

TEST(SpaceIncrement, OfATurnIsNone) {
  // A stress that turns with the body: nothing but the rotation, to second order in it.
  const double angle = 1e-6;
  Matrix3d before;
  before << -1, 0.1, 0.3, 0.1, -2, 0, 0.3, 0, -4;
  const Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  const SpaceIncrement out =
      increment_of(turn - Matrix3d::Identity(), before, turn * before * turn.transpose());
  EXPECT_LT(out.stress.norm(), 50 * angle * angle);
  EXPECT_LT(out.strain.norm(), 10 * angle * angle);
}

// Realizations whose stiffness scatters about a mean, as those of packings do: every component of
// every probe's stress is off by `scatter` of the normal ones.
std::vector<SpaceIncrements> ensemble(const Stiffness& mean, int realizations, double scatter,
                                      std::mt19937_64& bits, bool shears) {
  std::normal_distribution<double> normal(0, scatter * mean(0, 0) * 1e-5);
  std::vector<SpaceIncrements> out;
  for (int r = 0; r < realizations; ++r) {
    SpaceIncrements one = increments(mean, shears);
    for (SpaceIncrement& increment : one) {
      for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) {
          increment.stress(a, b) += normal(bits);
          increment.stress(b, a) = increment.stress(a, b);
        }
      }
    }
    out.push_back(std::move(one));
  }
  return out;
}

TEST(SpaceSymmetry, RefusesWhatHoldsAboutOnceInTwenty) {
  std::mt19937_64 bits(7);
  constexpr int kTrials = 200;
  ElasticOptions options;
  options.bootstrap.resamples = 300;
  int refused = 0, refused_by_samples = 0, refused_transverse = 0;
  for (int t = 0; t < kTrials; ++t) {
    const SpaceSymmetry s =
        space_symmetry(ensemble(isotropic(1, 0.2), 10, 0.05, bits, true), options);
    refused += s.isotropic.p_realizations < 0.05;
    refused_by_samples += s.isotropic.p_samples < 0.05;
    refused_transverse += s.transverse.p_samples < 0.05;
  }
  // 10 of 200 expected; a binomial count lies within 1 to 22 in all but 3 of 10,000 cases. Draws of
  // ten realizations know their covariance within a third, which widens that of Hotelling's test.
  EXPECT_GE(refused_by_samples, 1);
  EXPECT_LE(refused_by_samples, 22);
  EXPECT_GE(refused_transverse, 1);
  EXPECT_LE(refused_transverse, 22);
  EXPECT_LE(refused, 30);
}

TEST(SpaceSymmetry, TellsWhichOneTheGrainsSupport) {
  std::mt19937_64 bits(3);
  const ElasticOptions options;
  const Stiffness five = transverse(1, 1.4, 0.2, 0.2, 0.5);
  Stiffness nine = five;
  nine(0, 0) *= 1.3;
  nine(3, 3) *= 1.3;
  EXPECT_EQ(space_symmetry(ensemble(five, 8, 0.02, bits, true), options).symmetry(),
            "transversely isotropic");
  EXPECT_EQ(space_symmetry(ensemble(five, 8, 0.02, bits, false), options).symmetry(),
            "transversely isotropic");
  EXPECT_EQ(space_symmetry(ensemble(nine, 8, 0.02, bits, true), options).symmetry(), "less");
  // One realization: the F test of its equations alone.
  const SpaceSymmetry one = space_symmetry(ensemble(five, 1, 0.01, bits, true), options);
  EXPECT_TRUE(std::isnan(one.isotropic.p_realizations));
  EXPECT_LT(one.isotropic.p_samples, 0.05);
  EXPECT_EQ(space_symmetry({}, options).symmetry(), "not known");
}

}  // namespace
}  // namespace grainfield::coupling
