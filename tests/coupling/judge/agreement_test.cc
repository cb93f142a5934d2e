// Agreement of many tied values with what they should be: how often chance alone refuses it, and
// what it finds.
//
// The table of docs/statistics.md:
// build/release/tests/coupling_judge agreement_test --gtest_also_run_disabled_tests
// --gtest_filter='*ChanceRefuses*:*ManyTrialsFind*' | grep '^|'
#include "coupling/statistics/agreement.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

namespace grainfield::coupling {
namespace {

constexpr int kPlaces = 30, kComponents = 3;
// Trials of the suite, and of the draws that docs/statistics.md tells powers of.
constexpr int kTrials = 1000, kManyTrials = 20000;

// Three components that are tied at a place (0.5), correlated over `length` places, and of a
// variance that falls off from the middle.
struct Noise {
  Eigen::MatrixXd root;
  std::mt19937_64 random{3};
  std::normal_distribution<double> normal;

  explicit Noise(double length, double grade) {
    const int n = kPlaces * kComponents;
    Eigen::MatrixXd c(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const double d = (i % kPlaces - j % kPlaces) / length;
        const double off = std::abs(i % kPlaces - 15) + std::abs(j % kPlaces - 15);
        c(i, j) = std::exp(-grade * off / kPlaces - 0.5 * d * d) *
                  (i / kPlaces == j / kPlaces ? 1 : 0.5) * (i == j ? 1 + 1e-6 : 1);
      }
    }
    root = Eigen::LLT<Eigen::MatrixXd>(c).matrixL();
  }
  Eigen::MatrixXd draw(int realizations) {
    Eigen::MatrixXd z(root.rows(), realizations);
    for (double& v : z.reshaped()) v = normal(random);
    return root * z;
  }
};

double share_refused(Noise& noise, int realizations, double offset, int trials = kTrials) {
  int refused = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const Eigen::MatrixXd y = noise.draw(realizations);
    const Eigen::VectorXd mean = y.rowwise().mean();
    refused +=
        agreement(mean.array() + offset, Eigen::MatrixXd(y.colwise() - mean)).holds() ? 0 : 1;
  }
  return refused / static_cast<double>(trials);
}

// Nominal: 1 of 100. The bounds are three standard deviations of the count above 2 of 100. Prints
// rows of docs/statistics.md.
TEST(Agreement, ChanceRefusesATrueModelRarely) {
  std::map<int, double> worst;
  for (const double length : {0.5, 3.0, 10.0}) {
    for (const double grade : {0.0, 3.0}) {
      Noise noise(length, grade);
      for (const int realizations : {3, 4, 8, 16}) {
        const double share = share_refused(noise, realizations, 0);
        worst[realizations] = std::max(worst[realizations], share);
        EXPECT_LE(share, 0.033) << length << " " << grade << " " << realizations;
      }
    }
  }
  for (const auto& [realizations, share] : worst) {
    std::printf("| F: true model refused, worst of six noises | %d | %.1f %% |\n", realizations,
                100 * share);
  }
}

// An offset everywhere, in standard deviations of a single realization. Prints rows of
// docs/statistics.md. The floors are 5 points below what kManyTrials find.
void find_what_is_off(int trials) {
  Noise noise(3, 0);
  struct Row {
    int realizations;
    double offset, least;
  };
  for (const Row& row : {Row{4, 1, 0.67}, Row{8, 1, 0.95}, Row{16, 1, 0.95}, Row{4, 2, 0.95},
                         Row{8, 2, 0.95}, Row{16, 2, 0.95}}) {
    const double found = share_refused(noise, row.realizations, row.offset, trials);
    std::printf("| F: off by %g standard deviations, floor %.0f %% | %d | %.1f %% |\n", row.offset,
                100 * row.least, row.realizations, 100 * found);
    EXPECT_GE(found, row.least) << row.realizations << " " << row.offset;
  }
}

TEST(Agreement, FindsWhatIsOff) { find_what_is_off(kTrials); }
TEST(Agreement, DISABLED_ManyTrialsFindWhatIsOff) { find_what_is_off(kManyTrials); }

TEST(Agreement, KnownErrors) {
  Eigen::VectorXd errors = Eigen::VectorXd::Constant(100, 2), off = errors;
  const Agreement a = agreement(off, errors, 1);
  EXPECT_NEAR(a.values, 100, 1e-9);
  EXPECT_NEAR(a.ratio, 1, 1e-12);
  EXPECT_TRUE(a.holds());
  EXPECT_FALSE(agreement(2 * off, errors, 1).holds());
  EXPECT_NEAR(agreement(off, errors, 4).values, 25, 1e-9);
}

TEST(Agreement, WithoutSpreadThereIsNone) {
  const Eigen::VectorXd off = Eigen::VectorXd::Ones(5);
  EXPECT_TRUE(std::isnan(agreement(off, Eigen::MatrixXd::Zero(5, 4)).ratio));
  EXPECT_TRUE(std::isnan(agreement(off, Eigen::MatrixXd::Zero(5, 1)).ratio));
  EXPECT_FALSE(agreement(off, Eigen::MatrixXd::Zero(5, 4)).holds());
}

}  // namespace
}  // namespace grainfield::coupling
