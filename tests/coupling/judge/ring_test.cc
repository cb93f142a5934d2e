// A ring or a peak under a point load: false alarms, power and what is refused.
#include "coupling/compare/ring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kPlaces = 31;
VectorXd radii() { return VectorXd::LinSpaced(kPlaces, 0, 1.5); }

// Flat within 0.6, with an elevation at 0.4: noise of neighbours alike over 0.1, larger where fewer
// grains are (on the axis).
MatrixXd ensemble(std::mt19937& random, int realizations, double elevation) {
  std::normal_distribution<double> normal;
  const VectorXd r = radii();
  MatrixXd out(kPlaces, realizations);
  for (int k = 0; k < realizations; ++k) {
    VectorXd noise(kPlaces + 2);
    for (double& value : noise) value = normal(random);
    for (Index i = 0; i < kPlaces; ++i) {
      const double shape = r[i] < 0.6 ? 1 : std::exp(-8 * std::pow(r[i] - 0.6, 2));
      const double ring = elevation * std::exp(-std::pow((r[i] - 0.4) / 0.1, 2));
      const double wide = r[i] < 0.1 ? 0.2 : 0.08;
      out(i, k) = shape + ring + wide * (noise[i] + noise[i + 1] + noise[i + 2]) / std::sqrt(3.0);
    }
  }
  return out;
}

struct Rates {
  double ring = 0, peak = 0;
};
Rates rates(double elevation, int realizations, int trials = 2000) {
  std::mt19937 random(7);
  Rates out;
  for (int t = 0; t < trials; ++t) {
    const std::string word =
        ring_against_axis(radii(), ensemble(random, realizations, elevation), 0.2).word();
    out.ring += word == "ring" ? 1.0 / trials : 0;
    out.peak += word == "peak" ? 1.0 / trials : 0;
  }
  return out;
}

TEST(Ring, FlatResponsesAreSeldomRings) {
  for (const int realizations : {4, 8, 16}) {
    const Rates r = rates(0, realizations);
    EXPECT_LT(r.ring, 0.04) << realizations;  // 2.5 % on either side
    EXPECT_LT(r.peak, 0.05) << realizations;
  }
}

TEST(Ring, RingsAndPeaksAreSeen) {
  EXPECT_GT(rates(0.3, 8).ring, 0.85);
  EXPECT_EQ(rates(0.3, 8).peak, 0);
  std::mt19937 random(3);
  MatrixXd pointed = ensemble(random, 8, 0);
  pointed.row(0).array() += 0.6;
  const RingAgainstAxis found = ring_against_axis(radii(), pointed, 0.2);
  EXPECT_EQ(found.word(), "peak");
  EXPECT_NEAR(found.difference, -0.6, 0.25);
}

TEST(Ring, ExactFigures) {
  MatrixXd samples = MatrixXd::Zero(kPlaces, 3);
  samples.row(8) << 2.0, 3.0, 4.0;  // r = 0.4
  samples.row(0) << 1.0, 1.0, 1.0;
  const RingAgainstAxis found = ring_against_axis(radii(), samples, 0.2);
  EXPECT_NEAR(found.at, 0.4, 1e-12);
  EXPECT_NEAR(found.difference, 2, 1e-12);
  EXPECT_NEAR(found.error, 1 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(found.p, 0.0742, 1e-4);  // t = 3.4641 of two degrees of freedom
  EXPECT_EQ(found.word(), "neither");
}

TEST(Ring, WithoutEnoughNothingIsSaid) {
  EXPECT_EQ(ring_against_axis(radii(), MatrixXd::Ones(kPlaces, 2), 0.2).word(), "");
  EXPECT_EQ(ring_against_axis(radii(), MatrixXd::Random(kPlaces, 8), 2).word(), "");
  EXPECT_EQ(ring_against_axis(radii(), MatrixXd::Random(kPlaces, 8), 0).word(), "");
  MatrixXd hole = MatrixXd::Random(kPlaces, 8);
  hole(20, 3) = std::nan("");
  EXPECT_EQ(ring_against_axis(radii(), hole, 0.2).word(), "");
}

}  // namespace
}  // namespace grainfield::coupling
