// Fits of stress models: known constants come back within their errors, and the choice between
// models names the one that made the data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "coupling/fit/models.h"
#include "coupling/fit/selection.h"
#include "dem/random/random.h"

namespace grainfield::coupling {
namespace {

constexpr double kSlope = 28, kRhoG = 4e4, kHeight = 0.2;

double normal(dem::Random& random) {
  double sum = -6;  // of twelve uniform numbers: variance 1, to 3 deviations close to normal
  for (int k = 0; k < 12; ++k) sum += random.uniform();
  return sum;
}

// Three heights, all components, `per` points on each.
FitData places(int per) {
  FitData data;
  data.components = {"sigma_xx", "sigma_yy", "sigma_xy"};
  data.levels = {"0.1", "0.4", "0.6"};
  const std::vector<double> heights{0.1, 0.4, 0.6};
  std::vector<Eigen::Vector2d> points;
  for (int c = 0; c < 3; ++c) {
    for (int level = 0; level < 3; ++level) {
      const double y = -(1 - heights[level]) * kHeight;
      const double half = 0.95 * -y / std::tan(kSlope * M_PI / 180);
      for (int k = 0; k < per; ++k) {
        points.emplace_back(-half + 2 * half * k / (per - 1), y);
        data.component.push_back(c);
        data.level.push_back(level);
      }
    }
  }
  data.points.resize(points.size(), 2);
  for (std::size_t k = 0; k < points.size(); ++k) data.points.row(k) = points[k].transpose();
  data.samples.resize(points.size(), 1);
  return data;
}

// Realizations: the truth and correlated noise (Gaussian over `length`) of `share` of rho g h.
void fill(FitData& data, const Eigen::VectorXd& truth, int realizations, double share,
          double length, dem::Random& random) {
  const int n = data.values();
  Eigen::MatrixXd correlation(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double d = (data.points.row(i) - data.points.row(j)).norm() / length;
      correlation(i, j) = data.component[i] != data.component[j] ? 0 : std::exp(-0.5 * d * d);
    }
    correlation(i, i) += 1e-6;
  }
  const Eigen::MatrixXd root = Eigen::LLT<Eigen::MatrixXd>(correlation).matrixL();
  data.samples.resize(n, realizations);
  for (int r = 0; r < realizations; ++r) {
    Eigen::VectorXd noise(n);
    for (int k = 0; k < n; ++k) noise[k] = normal(random);
    data.samples.col(r) = truth + share * kRhoG * kHeight * (root * noise);
  }
}

Eigen::VectorXd vector(std::initializer_list<double> v) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(v.size()));
  std::copy(v.begin(), v.end(), out.data());
  return out;
}

struct Truth {
  std::string model;
  Eigen::VectorXd parameters;
};

std::vector<Truth> truths() {
  return {{"cantelaube_continuous", vector({33})},
          {"cantelaube", vector({0.34, 0.49, -0.2, 0.78, 1.23, 0.38, 35})},
          {"osl_yield", vector({-0.3})},
          {"osl", vector({0.74, -0.31})}};
}

TEST(Fit, WithoutNoiseTheConstantsComeBack) {
  const auto models = heap_models({kSlope, kRhoG, kHeight});
  for (const Truth& truth : truths()) {
    const FitModel& model = find_fit_model(models, truth.model);
    FitData data = places(41);
    data.samples.col(0) = predict(data, model, truth.parameters);
    const Covariance covariance = covariance_of(data);
    EXPECT_EQ(covariance.kind, "unknown");
    const Fit f = fit(data, covariance, model);
    EXPECT_LT(f.rel_l2, 1e-3) << truth.model;
    for (std::size_t k = 0; k < f.parameters.size(); ++k) {
      EXPECT_NEAR(f.parameters[k].value, truth.parameters[k],
                  1e-2 * (1 + std::fabs(truth.parameters[k])))
          << truth.model << " " << f.parameters[k].parameter.name;
      EXPECT_TRUE(std::isnan(f.parameters[k].error));
    }
  }
}

// Of 100 ensembles of 8 piles the 95 % intervals hold the truth in at least 90.
TEST(Fit, IntervalsCoverTheTruth) {
  const auto models = heap_models({kSlope, kRhoG, kHeight});
  dem::Random random(11);
  for (const Truth& truth : truths()) {
    const FitModel& model = find_fit_model(models, truth.model);
    FitData data = places(15);
    const Eigen::VectorXd exact = predict(data, model, truth.parameters);
    std::vector<int> inside(model.parameters.size(), 0);
    for (int trial = 0; trial < 100; ++trial) {
      fill(data, exact, 8, 0.05, 0.03, random);
      FitOptions options;
      options.bootstrap = 0;
      const Fit f = fit(data, covariance_of(data), model, options);
      for (std::size_t k = 0; k < inside.size(); ++k) {
        inside[k] +=
            f.parameters[k].low < truth.parameters[k] && truth.parameters[k] < f.parameters[k].high;
      }
    }
    for (std::size_t k = 0; k < inside.size(); ++k) {
      EXPECT_GE(inside[k], 90) << truth.model << " " << model.parameters[k].name;
    }
  }
}

TEST(Fit, CovarianceFindsSizeAndLengthOfTheNoise) {
  dem::Random random(5);
  FitData data = places(25);
  double length = 0, error = 0;
  for (int trial = 0; trial < 20; ++trial) {
    fill(data, Eigen::VectorXd::Zero(data.values()), 10, 0.1, 0.03, random);
    const Covariance c = covariance_of(data);
    EXPECT_EQ(c.kind, "parametric");
    length += c.correlation_length / 20;
    error += c.of_mean.diagonal().mean() / 20;
  }
  // Matern's length that is nearest to a Gaussian of 0.03 m.
  EXPECT_GT(length, 0.02);
  EXPECT_LT(length, 0.08);
  EXPECT_NEAR(std::sqrt(error), 0.1 * kRhoG * kHeight / std::sqrt(10),
              0.05 * kRhoG * kHeight * 0.1);
}

TEST(Fit, FallsBackWithANote) {
  dem::Random random(6);
  FitData data = places(9);
  fill(data, Eigen::VectorXd::Zero(data.values()), 5, 0.1, 0.03, random);
  EXPECT_THAT(covariance_of(data, "sample").note,
              testing::HasSubstr("sample covariance of 81 values needs 84 realizations, found 5"));
  EXPECT_EQ(covariance_of(data, "sample").kind, "parametric");
  EXPECT_EQ(covariance_of(data, "diagonal").kind, "diagonal");
  EXPECT_LT(covariance_of(data, "diagonal").effective_values, 81);
  fill(data, Eigen::VectorXd::Zero(data.values()), 2, 0.1, 0.03, random);
  EXPECT_EQ(covariance_of(data).kind, "diagonal");
  EXPECT_THAT(covariance_of(data).note, testing::HasSubstr("needs 3 realizations, found 2"));
  EXPECT_THROW(covariance_of(data, "full"), std::invalid_argument);
  fill(data, Eigen::VectorXd::Zero(data.values()), 100, 0.1, 0.03, random);
  EXPECT_EQ(covariance_of(data, "sample").kind, "sample");
}

// Of 100 ensembles at least 95 name the model that made them; with an effect far below the noise
// hardly any does.
TEST(Fit, SelectionNamesTheModelThatMadeTheData) {
  const auto all = heap_models({kSlope, kRhoG, kHeight});
  const std::vector<FitModel> models{
      find_fit_model(all, "cantelaube_minus"), find_fit_model(all, "cantelaube_plus"),
      find_fit_model(all, "osl_yield"), find_fit_model(all, "hydrostatic")};
  dem::Random random(12);
  FitData data = places(11);
  FitOptions options;
  options.bootstrap = 0;
  const auto wins = [&](const Eigen::VectorXd& exact, double noise, const std::string& name) {
    int named = 0;
    for (int trial = 0; trial < 100; ++trial) {
      fill(data, exact, 8, noise, 0.03, random);
      const Covariance c = covariance_of(data);
      std::vector<Fit> fits;
      for (const FitModel& m : models) fits.push_back(fit(data, c, m, options));
      const Selection s = select(data, c, models, fits);
      named += s.distinguishable && s.ranking.front().name == name;
    }
    return named;
  };
  const Eigen::VectorXd minus = predict(data, models[0], Eigen::VectorXd(0));
  const Eigen::VectorXd osl = predict(data, models[2], vector({-0.3}));
  EXPECT_GE(wins(minus, 0.03, "cantelaube_minus"), 95);
  EXPECT_GE(wins(osl, 0.03, "osl_yield"), 95);
  EXPECT_LE(wins(minus, 2, "cantelaube_minus"), 5);
}

TEST(Fit, BadData) {
  FitData data = places(5);
  data.samples.setZero();
  data.components[0] = "pressure";
  EXPECT_THROW(covariance_of(data), std::invalid_argument);
  data = places(5);
  data.samples.setConstant(std::nan(""));
  EXPECT_THROW(covariance_of(data), std::invalid_argument);
  EXPECT_THROW(find_fit_model(heap_models({}), "jansen"), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::coupling
