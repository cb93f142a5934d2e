// The misfit beyond the noise of a mean: without bias, and its bound holds the truth.
#include "coupling/compare/beyond_noise.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace grainfield::coupling {
namespace {

struct Trials {
  double mean = 0, held = 0, plain = 0;
};

// Ensembles of a truth that is off the model by `off` of it, with correlated noise.
Trials trials(double off, int realizations) {
  constexpr int kTrials = 2000, kPlaces = 40;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const Eigen::VectorXd model = Eigen::VectorXd::LinSpaced(kPlaces, 1, 2);
  const Eigen::VectorXd truth = (1 + off) * model;
  Trials out;
  for (int t = 0; t < kTrials; ++t) {
    Eigen::MatrixXd samples(kPlaces, realizations);
    for (int r = 0; r < realizations; ++r) {
      const double common = normal(random);
      for (int k = 0; k < kPlaces; ++k)
        samples(k, r) = truth[k] + 0.2 * normal(random) + 0.1 * common;
    }
    const BeyondNoise b = misfit_beyond_noise(samples, model);
    out.mean += b.squared / kTrials;
    out.plain += (b.squared + b.noise) / kTrials;
    out.held += (b.right_to() >= std::fabs(off)) / static_cast<double>(kTrials);
  }
  return out;
}

TEST(BeyondNoise, HasNoBias) {
  for (const double off : {0.0, 0.05, 0.2}) {
    const Trials t = trials(off, 8);
    EXPECT_NEAR(t.mean, off * off, 1e-3) << off;
    EXPECT_GT(t.plain, off * off + 1.5e-3) << off;
  }
}

TEST(BeyondNoise, IsBounded) {
  for (const double off : {0.02, 0.05, 0.2}) EXPECT_GT(trials(off, 8).held, 0.93) << off;
}

TEST(BeyondNoise, LeavesOutWhatIsNotKnown) {
  Eigen::MatrixXd samples(3, 3);
  samples << 1, 2, 3, kNan, 1, 1, 4, 4, 4;
  const BeyondNoise b = misfit_beyond_noise(samples, Eigen::Vector3d(1, 1, 4));
  EXPECT_NEAR(b.noise, 2.0 / 6 / 17, 1e-12);
  EXPECT_NEAR(b.squared, 1.0 / 17 - 2.0 / 6 / 17, 1e-12);
  EXPECT_TRUE(
      std::isnan(misfit_beyond_noise(samples.leftCols(1), Eigen::Vector3d(1, 1, 4)).squared));
  EXPECT_TRUE(
      std::isnan(misfit_beyond_noise(samples.leftCols(2), Eigen::Vector3d(1, 1, 4)).right_to()));
  EXPECT_THROW(misfit_beyond_noise(samples, Eigen::Vector2d(1, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::coupling
