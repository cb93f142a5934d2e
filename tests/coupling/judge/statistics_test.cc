// Bootstrap, least squares, correlation and exponential tails against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "coupling/statistics/bootstrap.h"
#include "coupling/statistics/correlation.h"
#include "coupling/statistics/exponential_tail.h"
#include "coupling/statistics/holm.h"
#include "coupling/statistics/least_squares.h"
#include "coupling/statistics/parallel.h"
#include "coupling/statistics/spread.h"
#include "dem/random/random.h"

namespace grainfield::coupling {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string text_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

double normal(dem::Random& random) {
  const double u = 1 - random.uniform(), v = random.uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

Eigen::VectorXd normals(dem::Random& random, int n) {
  Eigen::VectorXd x(n);
  for (double& value : x) value = normal(random);
  return x;
}

Eigen::VectorXd exponentials(dem::Random& random, int n, double rate = 1) {
  Eigen::VectorXd x(n);
  for (double& value : x) value = -std::log1p(-random.uniform()) / rate;
  return x;
}

// Mean of independent numbers with its interval.
BootstrapInterval bootstrap_mean(const Eigen::VectorXd& numbers, const BootstrapOptions& options) {
  const auto mean = [&](const std::vector<int>& chosen) {
    double sum = 0;
    for (const int r : chosen) sum += numbers[r];
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, sum / static_cast<double>(chosen.size())));
  };
  return bootstrap(static_cast<int>(numbers.size()), mean, options).front();
}

TEST(Spread, MeanAndStandardError) {
  const Spread s = spread_of({1, 2, 6});
  EXPECT_EQ(s.values, 3);
  EXPECT_DOUBLE_EQ(s.mean, 3);
  EXPECT_DOUBLE_EQ(s.standard_error, std::sqrt(7. / 3));
  EXPECT_TRUE(std::isnan(spread_of({}).mean));
  EXPECT_TRUE(std::isnan(spread_of({5}).standard_error));
  EXPECT_EQ(spread_of({5}).mean, 5);
  EXPECT_TRUE(std::isnan(spread_of({nan, 1}).mean));
}

TEST(Bootstrap, ErrorOfTheMeanIsTheStandardError) {
  dem::Random random(1);
  const Eigen::VectorXd x = normals(random, 40);
  BootstrapOptions o;
  o.resamples = 20000;
  const BootstrapInterval i = bootstrap_mean(x, o);
  const Spread m = spread_of({x.begin(), x.end()});
  EXPECT_DOUBLE_EQ(i.value, m.mean);
  // The bootstrap's divisor is n, not n - 1; its own noise is 1/sqrt(2 x 20000) = 0.5 %.
  EXPECT_NEAR(i.error, m.standard_error * std::sqrt(39. / 40), 0.02 * m.standard_error);
  // Student's quantile of 39 degrees of freedom is 2.0227; the bootstrap's ends scatter by 2 %.
  EXPECT_NEAR(i.high - i.low, 2 * 2.0227 * m.standard_error, 0.1 * m.standard_error);
  o.widen = false;
  const BootstrapInterval plain = bootstrap_mean(x, o);
  EXPECT_NEAR(plain.high - plain.low, 2 * 1.96 * i.error, 0.1 * m.standard_error);
  EXPECT_EQ(i.undefined, 0);
}

// Share of trials whose interval holds the true value, for the mean of n numbers.
double coverage(const std::string& interval, bool skewed, int n) {
  int held = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    dem::Random random(1000 + trial);
    const Eigen::VectorXd x = skewed ? exponentials(random, n) : normals(random, n);
    BootstrapOptions o;
    o.interval = interval;
    o.resamples = 1000;
    o.seed = trial;
    const BootstrapInterval i = bootstrap_mean(x, o);
    const double truth = skewed ? 1 : 0;
    held += i.low <= truth && truth <= i.high;
  }
  return held / 200.0;
}

TEST(Bootstrap, NinetyFivePercentIntervalsHoldTheTruth) {
  for (const char* interval : {"bca", "percentile"})
    for (const bool skewed : {false, true}) {
      const double share = coverage(interval, skewed, 30);
      EXPECT_GE(share, 0.88) << interval << (skewed ? " skewed" : "");
      EXPECT_LE(share, 0.99) << interval << (skewed ? " skewed" : "");
    }
}

// The bca interval of the mean of exponential numbers leans to the long side.
TEST(Bootstrap, BcaFollowsSkewness) {
  dem::Random random(4);
  const Eigen::VectorXd x = exponentials(random, 25);
  BootstrapOptions bca, percentile;
  percentile.interval = "percentile";
  const BootstrapInterval a = bootstrap_mean(x, bca), b = bootstrap_mean(x, percentile);
  EXPECT_GT(a.low, b.low);
  EXPECT_GT(a.high, b.high);
  EXPECT_EQ(a.error, b.error);
}

TEST(Bootstrap, SameSeedSameBitsOnAnyThreads) {
  dem::Random random(2);
  const Eigen::VectorXd x = normals(random, 17);
  const auto statistic = [&](const std::vector<int>& chosen) {
    Eigen::Vector2d sum(0, 0);
    for (const int c : chosen) sum += Eigen::Vector2d(x[c], x[c] * x[c]);
    return Eigen::VectorXd(sum);
  };
  BootstrapOptions o;
  o.resamples = 501;
  const Eigen::MatrixXd one = bootstrap_draws(17, statistic, o);
  const auto intervals = bootstrap(17, statistic, o);
  for (const int threads : {2, 3, 8}) {
    o.threads = threads;
    EXPECT_EQ(one, bootstrap_draws(17, statistic, o));
    EXPECT_EQ(intervals[1].low, bootstrap(17, statistic, o)[1].low);
  }
  o.seed = 2;
  EXPECT_NE(one, bootstrap_draws(17, statistic, o));
  // Draws differ from each other, and seeds are not shifts of one another.
  const Eigen::MatrixXd other = bootstrap_draws(17, statistic, o);
  EXPECT_NE(one(1, 0), one(0, 0));
  EXPECT_NE(other(0, 0), one(1, 0));
}

// Every realization is drawn equally often: 200,000 draws of 7.
TEST(Bootstrap, DrawsAreUniform) {
  const auto counts = [](const std::vector<int>& chosen) {
    Eigen::VectorXd n = Eigen::VectorXd::Zero(7);
    for (const int c : chosen) n[c] += 1;
    return n;
  };
  BootstrapOptions o;
  o.resamples = 20000;
  const Eigen::VectorXd mean = bootstrap_draws(7, counts, o).colwise().mean().transpose();
  // Standard error sqrt(6/7 / 20000) = 0.0065.
  for (const double m : mean) EXPECT_NEAR(m, 1, 0.03);
}

TEST(Bootstrap, UndefinedDrawsAndConstants) {
  BootstrapOptions o;
  // Undefined unless realization 0 is drawn: (1 - 1/5)^5 = 33 % of the draws.
  const auto often = [](const std::vector<int>& chosen) {
    const bool there = std::find(chosen.begin(), chosen.end(), 0) != chosen.end();
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, there ? 1 : nan));
  };
  const BootstrapInterval i = bootstrap(5, often, o).front();
  EXPECT_EQ(i.value, 1);
  EXPECT_NEAR(i.undefined, 0.33 * o.resamples, 0.05 * o.resamples);
  EXPECT_TRUE(std::isnan(i.low) && std::isnan(i.high) && std::isnan(i.error));
  // A constant has an interval of no width; one realization has none.
  const BootstrapInterval c = bootstrap_mean(Eigen::VectorXd::Constant(6, 2.5), o);
  EXPECT_EQ(c.low, 2.5);
  EXPECT_EQ(c.high, 2.5);
  EXPECT_EQ(c.error, 0);
  const BootstrapInterval one = bootstrap_mean(Eigen::VectorXd::Constant(1, 2.5), o);
  EXPECT_EQ(one.value, 2.5);
  EXPECT_TRUE(std::isnan(one.low));
}

TEST(Bootstrap, Refusals) {
  const Eigen::VectorXd x = Eigen::VectorXd::Ones(3);
  const auto refusal = [&](const std::function<void(BootstrapOptions&)>& change) {
    BootstrapOptions o;
    change(o);
    return text_of([&] { bootstrap_mean(x, o); });
  };
  EXPECT_EQ(refusal([](BootstrapOptions& o) { o.interval = "bcb"; }),
            "unknown bootstrap interval \"bcb\"; known: bca, percentile; did you mean \"bca\"?");
  EXPECT_EQ(refusal([](BootstrapOptions& o) { o.level = 1; }),
            "bootstrap level is 1; it must be above 0 and below 1");
  EXPECT_EQ(refusal([](BootstrapOptions& o) { o.resamples = 9; }),
            "bootstrap with 9 resamples; at least 10 are needed");
  EXPECT_EQ(refusal([](BootstrapOptions& o) { o.threads = 0; }),
            "bootstrap on 0 threads; at least 1 is needed");
  EXPECT_EQ(text_of([] { bootstrap_mean(Eigen::VectorXd(0), {}); }),
            "bootstrap over 0 realizations; at least 1 is needed");
  // An error inside the statistic reaches the caller from whatever thread.
  BootstrapOptions o;
  o.threads = 4;
  int calls = 0;
  EXPECT_EQ(text_of([&] {
              in_parts(8, 4, [](int first, int) {
                if (first > 0) throw std::invalid_argument("part " + std::to_string(first));
              });
            }),
            "part 2");
  EXPECT_EQ(calls, 0);
}

TEST(LeastSquares, RecoversAndPropagates) {
  dem::Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 3 + static_cast<int>(random.uniform(0, 20)), k = 1 + trial % 3;
    Eigen::MatrixXd a(n, k), truth(k, 2);
    for (double& v : a.reshaped()) v = normal(random);
    for (double& v : truth.reshaped()) v = normal(random);
    Eigen::VectorXd w(n);
    for (double& v : w) v = random.uniform(0.1, 3);
    const LeastSquares fit = least_squares(a, a * truth, w);
    EXPECT_LT((fit.solution - truth).norm(), 1e-12 * fit.condition);
    const Eigen::MatrixXd normal_matrix = a.transpose() * w.asDiagonal() * a;
    EXPECT_LT((fit.covariance * normal_matrix - Eigen::MatrixXd::Identity(k, k)).norm(),
              1e-10 * fit.condition * fit.condition);
    EXPECT_EQ(fit.rank, k);
  }
  // Weights are numbers of repetitions.
  Eigen::MatrixXd a(3, 1), twice(4, 1), b(3, 1), b_twice(4, 1);
  a << 1, 2, 3;
  b << 1, 1, 4;
  twice << 1, 2, 3, 3;
  b_twice << 1, 1, 4, 4;
  const LeastSquares x = least_squares(a, b, Eigen::Vector3d(1, 1, 2)),
                     y = least_squares(twice, b_twice);
  EXPECT_NEAR(x.solution(0, 0), y.solution(0, 0), 1e-14);
  EXPECT_NEAR(x.solution(0, 0), (1. + 2 + 2 * 12) / (1 + 4 + 2 * 9), 1e-14);
  EXPECT_NEAR(x.residual, y.residual, 1e-13);
  EXPECT_NEAR(x.data, 1 + 1 + 2 * 16, 1e-13);
}

TEST(LeastSquares, DegenerateIsNanBadIsRefused) {
  Eigen::MatrixXd a(3, 2);
  a << 1, 2, 2, 4, 3, 6;
  const LeastSquares fit = least_squares(a, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(fit.rank, 1);
  EXPECT_TRUE(std::isinf(fit.condition));
  EXPECT_TRUE(std::isnan(fit.solution(0, 0)));
  EXPECT_EQ(least_squares(a.topRows(1), Eigen::VectorXd::Ones(1)).rank, 1);
  EXPECT_EQ(least_squares(a.topRows(0), Eigen::VectorXd(0)).rank, 0);
  EXPECT_EQ(text_of([&] { least_squares(a, Eigen::Vector2d(1, 2)); }),
            "least squares: 3 rows of the matrix, 2 of the right side");
  EXPECT_EQ(text_of([&] { least_squares(a, Eigen::Vector3d(1, 2, 3), Eigen::Vector2d(1, 1)); }),
            "least squares: 3 rows, 2 weights");
  EXPECT_EQ(text_of([&] { least_squares(a, Eigen::Vector3d(1, 2, nan)); }),
            "least squares: a number is not finite");
  EXPECT_EQ(text_of([&] { least_squares(a, Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(1, 1, -1)); }),
            "least squares: a weight is negative");
}

TEST(CorrelationTest, ClosedFormAndLine) {
  Eigen::VectorXd x(5), y(5);
  x << 1, 2, 3, 4, nan;
  y << 2, 4, 5, 4, 1;
  const Correlation c = correlation(x, y, {});
  // Deviations (-1.5 -0.5 0.5 1.5), (-1.75 0.25 1.25 0.25): 3.5 / sqrt(5 x 4.75).
  EXPECT_NEAR(c.r, 3.5 / std::sqrt(5 * 4.75), 1e-14);
  EXPECT_NEAR(c.slope, 0.7, 1e-14);
  EXPECT_NEAR(c.intercept, 2, 1e-13);
  EXPECT_EQ(c.pairs, 4);
  // A straight line far from the origin is still a straight line.
  const Eigen::VectorXd far = Eigen::VectorXd::LinSpaced(50, 1e6, 1e6 + 1);
  const Correlation line = correlation(far, (-3 * far).eval(), {});
  EXPECT_NEAR(line.r, -1, 1e-12);
  EXPECT_NEAR(line.slope, -3, 1e-8);
  EXPECT_NEAR(line.interval.low, -1, 1e-12);
  EXPECT_TRUE(std::isnan(correlation(x, Eigen::VectorXd::Constant(5, 0.1), {}).r));
  EXPECT_TRUE(std::isnan(correlation(x.head(2), y.head(2), {}).r));
  EXPECT_EQ(text_of([&] { correlation(x, y.head(3), {}); }),
            "correlation of 5 and 3 numbers of 5 realizations");
}

TEST(CorrelationTest, IntervalHoldsTheTruth) {
  int held = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    dem::Random random(trial + 77);
    const Eigen::VectorXd x = normals(random, 40), z = normals(random, 40);
    const Eigen::VectorXd y = 0.6 * x + 0.8 * z;
    BootstrapOptions o;
    o.resamples = 600;
    const Correlation c = correlation(x, y, o);
    held += c.interval.low <= 0.6 && 0.6 <= c.interval.high;
  }
  EXPECT_GE(held, 176);
  EXPECT_LE(held, 198);
}

// Repeating every pair ten times adds nothing: drawing whole realizations knows that.
TEST(CorrelationTest, RealizationsNotPointsAreIndependent) {
  dem::Random random(5);
  const Eigen::VectorXd x = normals(random, 30), y = x + normals(random, 30);
  Eigen::VectorXd many_x(300), many_y(300);
  std::vector<int> realization(300);
  for (int k = 0; k < 300; ++k) {
    many_x[k] = x[k % 30];
    many_y[k] = y[k % 30];
    realization[static_cast<std::size_t>(k)] = k % 30;
  }
  const Correlation once = correlation(x, y, {}),
                    blocks = correlation(many_x, many_y, realization, {}),
                    naive = correlation(many_x, many_y, {});
  EXPECT_NEAR(blocks.r, once.r, 1e-13);
  EXPECT_NEAR(blocks.interval.low, once.interval.low, 1e-12);
  EXPECT_EQ(blocks.realizations, 30);
  EXPECT_EQ(blocks.pairs, 300);
  const auto width = [](const Correlation& c) { return c.interval.high - c.interval.low; };
  EXPECT_NEAR(width(naive), width(blocks) / std::sqrt(10), 0.3 * width(naive));
}

TEST(ExponentialTailTest, RateIntervalAndGoodness) {
  int held = 0, rejected = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    dem::Random random(trial);
    TailOptions o;
    o.simulations = 200;
    o.seed = trial;
    const ExponentialTail t = exponential_tail(exponentials(random, 150, 1.5), 1, o);
    held += t.low <= 1.5 && 1.5 <= t.high;
    rejected += t.p_value < 0.05;
    EXPECT_NEAR(t.share, std::exp(-1.5), 0.15);
  }
  EXPECT_GE(held, 180);  // 95 % of 200 = 190, standard deviation 3
  EXPECT_LE(held, 199);
  EXPECT_GE(rejected, 2);  // 5 % of 200 = 10
  EXPECT_LE(rejected, 20);
}

// Holm 1979: by hand, with a tie, a step down that stops at 1 and a nan.
TEST(Holm, CorrectsForAllComparisons) {
  const std::vector<double> p = holm({0.01, 0.04, nan, 0.03, 0.005, 0.04});
  const std::vector<double> expected{0.04, 0.09, nan, 0.09, 0.025, 0.09};
  for (std::size_t k = 0; k < p.size(); ++k)
    EXPECT_TRUE(std::isnan(expected[k]) ? std::isnan(p[k]) : std::abs(p[k] - expected[k]) < 1e-15);
  EXPECT_EQ(holm({0.6, 0.7}), (std::vector<double>{1, 1}));
  EXPECT_TRUE(holm({}).empty());
}

// Under independent nulls at least one of eight is rejected in 5 % of the tables.
TEST(Holm, KeepsTheRateOfTables) {
  dem::Random random(3);
  int rejected = 0;
  for (int table = 0; table < 2000; ++table) {
    std::vector<double> p(8);
    for (double& v : p) v = random.uniform(0, 1);
    for (const double v : holm(p))
      if (v < 0.05) {
        ++rejected;
        break;
      }
  }
  EXPECT_NEAR(rejected, 98, 30);  // 1 - (1 - 0.05/8)^8 = 4.9 % of 2000, standard deviation 10
}

TEST(ExponentialTailTest, SeesWhatIsNotExponential) {
  dem::Random random(6);
  Eigen::VectorXd gauss = normals(random, 4000).cwiseAbs();
  const ExponentialTail t = exponential_tail(gauss, 0);
  EXPECT_LT(t.p_value, 0.01);
  EXPECT_NEAR(t.rate, std::sqrt(std::numbers::pi / 2), 0.05);
  Eigen::VectorXd few(4);
  few << 2, 3, nan, 0.5;
  const ExponentialTail none = exponential_tail(few, 1);
  EXPECT_EQ(none.count, 2);
  EXPECT_NEAR(none.share, 2. / 3, 1e-15);
  EXPECT_TRUE(std::isnan(none.rate) && std::isnan(none.p_value));
  Eigen::VectorXd known(3);
  known << 2, 3, 4;
  EXPECT_DOUBLE_EQ(exponential_tail(known, 1).rate, 0.5);
  EXPECT_EQ(text_of([&] { exponential_tail(known, nan); }),
            "the threshold of the tail is nan; it must be finite");
  EXPECT_EQ(text_of([&] {
              exponential_tail(known, 1, {2, 10, 1});
            }),
            "the tail's level is 2; it must be above 0 and below 1");
  EXPECT_EQ(text_of([&] {
              exponential_tail(known, 1, {0.95, 0, 1});
            }),
            "0 simulations of the tail; at least 1 is needed");
}

}  // namespace
}  // namespace grainfield::coupling
