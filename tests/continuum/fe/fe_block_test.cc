// A block of finite elements against closed forms: oedometric and triaxial compression and simple
// shear, elastic and flowing.
#include <gmock/gmock.h>

#include <cmath>

#include "continuum/block.h"
#include "continuum/constants.h"
#include "continuum/model.h"

namespace grainfield::continuum {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPressure = 100, kYoung = 1e5, kNu = 0.2;
// What Newton's method leaves (1e-11 of the stress), a hundred times.
constexpr double kExact = 1e-9 * kPressure;

BlockMaterial material(bool plastic, double friction = 30, double dilation = 10) {
  BlockMaterial m;
  m.constants = {kYoung, kNu, friction, dilation, 0};
  m.plastic = plastic;
  return m;
}

Matrix3d hydrostatic() { return -kPressure * Matrix3d::Identity(); }

// Shortening along z in equal parts while the sides' pressure is held.
std::vector<BlockLoad> triaxial(double strain, int parts) {
  std::vector<BlockLoad> path;
  for (int k = 1; k <= parts; ++k) {
    BlockLoad& load = path.emplace_back();
    load.strain.z() = -strain * k / parts;
    load.held = {true, true, false};
    load.stress = Vector3d::Constant(-kPressure);
  }
  return path;
}

TEST(FeBlock, ElasticClosedForms) {
  for (const int cells : {1, 2, 3}) {
    // Triaxial: Young's modulus and Poisson's ratio themselves.
    const auto states = load_block(material(false), hydrostatic(), triaxial(0.01, 4), cells);
    ASSERT_EQ(states.size(), 5U);
    EXPECT_NEAR(states[4].stress(2, 2), -kPressure - kYoung * 0.01, kExact);
    EXPECT_NEAR(states[4].strain(0, 0), kNu * 0.01, 1e-12);
    EXPECT_NEAR(states[4].strain(1, 1), kNu * 0.01, 1e-12);
    // Oedometric: M = E (1 - nu)/((1 + nu)(1 - 2 nu)), K0 = nu/(1 - nu).
    BlockLoad load;
    load.strain.z() = -0.01;
    const auto oedometric = load_block(material(false), hydrostatic(), {load}, cells);
    const double m = kYoung * (1 - kNu) / ((1 + kNu) * (1 - 2 * kNu));
    EXPECT_NEAR(oedometric[1].stress(2, 2), -kPressure - m * 0.01, kExact);
    EXPECT_NEAR(oedometric[1].stress(0, 0), -kPressure - m * 0.01 * kNu / (1 - kNu), kExact);
    EXPECT_NEAR(oedometric[1].plastic_strain, 0, 1e-12);
    // Shear: G gamma.
    load = {};
    load.shear = 0.02;
    const auto sheared = load_block(material(false), hydrostatic(), {load}, cells);
    EXPECT_NEAR(sheared[1].stress(0, 2), kYoung / (2 * (1 + kNu)) * 0.02, kExact);
    EXPECT_NEAR(sheared[1].stress(0, 1), 0, kExact);
  }
}

// sigma_1 = sigma_3 (1 + sin phi)/(1 - sin phi) from where E eps reaches it, and from there on
// d volume / d eps_1 = 2 sin psi/(1 - sin psi), dilation positive.
TEST(FeBlock, TriaxialFlow) {
  for (const auto& [friction, dilation] : {std::pair(30.0, 10.0), {40.0, 0.0}, {25.0, 25.0}}) {
    for (const int cells : {1, 2}) {
      const auto states =
          load_block(material(true, friction, dilation), hydrostatic(), triaxial(0.02, 10), cells);
      const double s = std::sin(friction * kDegree), d = std::sin(dilation * kDegree);
      const double limit = kPressure * (1 + s) / (1 - s);
      const double yields_at = (limit - kPressure) / kYoung;
      for (std::size_t k = 0; k < states.size(); ++k) {
        const double e = 0.002 * static_cast<double>(k);
        const double beyond = std::max(0.0, e - yields_at), elastic = e - beyond;
        EXPECT_NEAR(states[k].stress(2, 2), -kPressure - kYoung * elastic, kExact) << friction;
        EXPECT_NEAR(states[k].stress(0, 0), -kPressure, kExact);
        EXPECT_NEAR(states[k].strain.trace(), -(1 - 2 * kNu) * elastic + 2 * d / (1 - d) * beyond,
                    1e-11)
            << friction << " " << dilation << " " << k;
        EXPECT_NEAR(states[k].strain(0, 0), states[k].strain(1, 1), 1e-11);
      }
      EXPECT_GT(states.back().plastic_strain, 0.5 * (0.02 - yields_at));
    }
  }
}

// Constant volume and no dilation: tau = G gamma up to p sin phi, p stays; along the planes that
// slide tau/sigma = sin phi.
TEST(FeBlock, ShearAtConstantVolume) {
  std::vector<BlockLoad> path(8);
  for (std::size_t k = 0; k < path.size(); ++k) {
    path[k].shear = 5e-4 * static_cast<double>(k + 1);
  }
  const auto states = load_block(material(true, 30, 0), hydrostatic(), path, 2);
  const double g = kYoung / (2 * (1 + kNu));
  for (std::size_t k = 0; k < states.size(); ++k) {
    const double gamma = 5e-4 * static_cast<double>(k);
    EXPECT_NEAR(states[k].stress(0, 2), std::min(g * gamma, kPressure * 0.5), kExact) << k;
    EXPECT_NEAR(states[k].stress.trace(), -3 * kPressure, 10 * kExact);
  }
}

// Under constant normal stress it dilates: d eps_zz / d gamma = tan psi in the end, where the
// principal directions of stress and of the increments of strain are the same: tau/sigma =
// sin phi cos psi/(1 - sin phi sin psi) (Davis 1968).
TEST(FeBlock, ShearUnderConstantStress) {
  std::vector<BlockLoad> path(40);
  for (std::size_t k = 0; k < path.size(); ++k) {
    path[k].shear = 2e-3 * static_cast<double>(k + 1);
    path[k].held = {false, false, true};
    path[k].stress.z() = -kPressure;
  }
  const double friction = 35, dilation = 12;
  const auto states = load_block(material(true, friction, dilation), hydrostatic(), path, 2);
  const double s = std::sin(friction * kDegree), d = dilation * kDegree;
  const double slope = (states[40].strain(2, 2) - states[39].strain(2, 2)) / 2e-3;
  EXPECT_NEAR(slope, std::tan(d), 1e-6);
  EXPECT_NEAR(states[40].stress(0, 2) / kPressure, s * std::cos(d) / (1 - s * std::sin(d)), 1e-6);
  EXPECT_NEAR(states[40].stress(2, 2), -kPressure, kExact);
}

// Without lateral strain a hydrostatic block yields where K0 of elasticity is less than 1/N, N =
// (1 + sin phi)/(1 - sin phi), and flows at the edge s1 = N s3 of both lateral stresses s3. A
// plastic shortening l comes with lateral extensions M l/2 (M as N, of psi), which elastic ones
// take back: M l/2 = ((1 - nu)/N - nu) ds1/E, and so ds1 = E d eps/(1 - 2 nu/N + 2 ((1 - nu)/N -
// nu)/M). The way back is elastic.
TEST(FeBlock, OedometricFlowAndItsWayBack) {
  for (const auto& [friction, dilation] : {std::pair(20.0, 0.0), {25.0, 10.0}, {30.0, 30.0}}) {
    const double s = std::sin(friction * kDegree), d = std::sin(dilation * kDegree);
    const double n = (1 + s) / (1 - s), m = (1 + d) / (1 - d);
    const double oedometric = kYoung * (1 - kNu) / ((1 + kNu) * (1 - 2 * kNu));
    const double k0 = kNu / (1 - kNu);
    // p + M e = N (p + K0 M e).
    const double yields_at = kPressure * (n - 1) / (oedometric * (1 - n * k0));
    const double flowing = kYoung / (1 - 2 * kNu / n + 2 * ((1 - kNu) / n - kNu) / m);
    std::vector<BlockLoad> path(12);
    for (std::size_t k = 0; k < 8; ++k) path[k].strain.z() = -2e-3 * static_cast<double>(k + 1);
    for (std::size_t k = 8; k < 12; ++k) {
      path[k].strain.z() = path[7].strain.z() + 2e-5 * static_cast<double>(k - 7);
    }
    ASSERT_LT(yields_at, 0.8 * 0.016);
    const auto states = load_block(material(true, friction, dilation), hydrostatic(), path, 2);
    for (std::size_t k = 0; k <= 8; ++k) {
      const double e = 2e-3 * static_cast<double>(k);
      const double beyond = std::max(0.0, e - yields_at), elastic = e - beyond;
      const double axial = kPressure + oedometric * elastic + flowing * beyond;
      EXPECT_NEAR(states[k].stress(2, 2), -axial, 10 * kExact) << friction << " " << k;
      EXPECT_NEAR(states[k].stress(0, 0),
                  beyond > 0 ? -axial / n : -kPressure - k0 * oedometric * elastic, 10 * kExact);
    }
    for (std::size_t k = 9; k <= 12; ++k) {
      EXPECT_NEAR(states[k].stress(2, 2) - states[8].stress(2, 2),
                  oedometric * 2e-5 * static_cast<double>(k - 8), 10 * kExact);
    }
  }
}

// A held volume keeps what dilates from doing so: beyond tau = p sin phi the mean c of the stresses
// in the plane rises with tau = c sin phi. Plastic dilation lambda sin psi is taken back by the
// elastic compression dc/K', K' = E/(2 (1 + nu)(1 - 2 nu)), and d gamma = lambda + dtau/G. Across
// the plane the stress follows by 2 nu dc.
TEST(FeBlock, ShearAtConstantVolumeBuildsUpPressureWhereItWouldDilate) {
  const double g = kYoung / (2 * (1 + kNu));
  for (const auto& [friction, dilation] : {std::pair(30.0, 12.0), {40.0, 5.0}, {25.0, 25.0}}) {
    const double s = std::sin(friction * kDegree), d = std::sin(dilation * kDegree);
    const double rise = 1 / ((2 * (1 + kNu) * (1 - 2 * kNu)) / (kYoung * d) + s / g);
    std::vector<BlockLoad> path(8);
    for (std::size_t k = 0; k < path.size(); ++k) {
      path[k].shear = 1e-3 * static_cast<double>(k + 1);
    }
    const auto states = load_block(material(true, friction, dilation), hydrostatic(), path, 2);
    for (std::size_t k = 0; k < states.size(); ++k) {
      const double gamma = 1e-3 * static_cast<double>(k);
      const double beyond = std::max(0.0, gamma - kPressure * s / g);
      const double c = kPressure + rise * beyond;
      EXPECT_NEAR(states[k].stress(0, 2), beyond > 0 ? c * s : g * gamma, 10 * kExact) << k;
      EXPECT_NEAR(states[k].stress(2, 2), -c, 10 * kExact) << friction << " " << k;
      EXPECT_NEAR(states[k].stress(1, 1), -kPressure - 2 * kNu * (c - kPressure), 10 * kExact);
    }
    EXPECT_GT(-states.back().stress(2, 2), 1.2 * kPressure);
  }
}

TEST(FeBlock, AFirstStressBeyondTheLimitIsReturned) {
  Matrix3d stress = hydrostatic();
  stress(2, 2) = -10 * kPressure;
  const auto states = load_block(material(true), stress, {}, 2);
  EXPECT_NEAR(states[0].stress(2, 2) / states[0].stress(0, 0), 3, 1e-9);
}

TEST(FeBlock, SaysWhatItCannotDo) {
  EXPECT_THROW(load_block(material(false), hydrostatic(), {}, 0), BadParameter);
  EXPECT_THROW(load_block(material(true, 95), hydrostatic(), {}, 1), BadParameter);
  // Stresses held on all sides beyond what the material bears.
  BlockLoad load;
  load.held = {true, true, true};
  load.stress = {-kPressure, -kPressure, -5 * kPressure};
  EXPECT_THROW(load_block(material(true), hydrostatic(), {load}, 1), ComputationFailed);
}

}  // namespace
}  // namespace grainfield::continuum
