// Synthetic heaps for tests of fits: known models and correlated noise.
#pragma once
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "coupling/fit/heap_models.h"
#include "coupling/fit/selection.h"
#include "dem/random/random.h"

namespace grainfield::coupling {
inline constexpr double kSlope = 28, kRhoG = 4e4, kHeight = 0.2;

inline double normal(dem::Random& random) {
  double sum = -6;  // of twelve uniform numbers: variance 1, to 3 deviations close to normal
  for (int k = 0; k < 12; ++k) sum += random.uniform();
  return sum;
}

// Three heights, all components, `per` points on each.
inline FitData places(int per, double left_deg = kSlope, double right_deg = kSlope) {
  FitData data;
  data.components = {"sigma_xx", "sigma_yy", "sigma_xy"};
  data.levels = {"0.1", "0.4", "0.6"};
  const std::vector<double> heights{0.1, 0.4, 0.6};
  std::vector<Eigen::Vector2d> points;
  for (int c = 0; c < 3; ++c) {
    for (int level = 0; level < 3; ++level) {
      const double y = -(1 - heights[level]) * kHeight;
      const double left = 0.95 * y / std::tan(left_deg * std::numbers::pi / 180);
      const double right = 0.95 * -y / std::tan(right_deg * std::numbers::pi / 180);
      for (int k = 0; k < per; ++k) {
        points.emplace_back(left + (right - left) * k / (per - 1), y);
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
inline void fill(FitData& data, const Eigen::VectorXd& truth, int realizations, double share,
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

// Noise as grains have it: components of a point are tied, its size grows with the depth and is
// another for every component, and it leans to one side.
inline void fill_as_grains(FitData& data, const Eigen::VectorXd& truth, int realizations,
                           double share, dem::Random& random, double length = 0.03) {
  FitData gauss = data;
  fill(gauss, Eigen::VectorXd::Zero(data.values()), realizations, share, length, random);
  const int per = data.values() / 3;
  data.samples.resize(data.values(), realizations);
  for (int k = 0; k < data.values(); ++k) {
    const double size = (0.4 + 0.4 * (k / per)) * (0.3 - data.points(k, 1) / kHeight);
    for (int r = 0; r < realizations; ++r) {
      const double z =
          (0.8 * gauss.samples(k, r) + 0.6 * gauss.samples(k % per, r)) / (share * kRhoG * kHeight);
      data.samples(k, r) = truth[k] + share * kRhoG * kHeight * size * (z + 0.15 * (z * z - 1));
    }
  }
}

inline Eigen::VectorXd vector(std::initializer_list<double> v) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(v.size()));
  std::copy(v.begin(), v.end(), out.data());
  return out;
}

struct Truth {
  std::string model;
  Eigen::VectorXd parameters;
};

inline std::vector<Truth> truths() {
  return {{"cantelaube_continuous", vector({33})},
          {"cantelaube", vector({0.34, 0.49, -0.2, 0.78, 1.23, 0.38, 35})},
          {"osl_yield", vector({-0.3})},
          {"osl", vector({0.74, -0.31})}};
}

// Heaps with two slopes, 31 degrees on the left and 22 on the right.
inline constexpr double kLeft = 31, kRight = 22;
inline HeapFacts two_slopes() {
  HeapFacts facts{(kLeft + kRight) / 2, kRhoG, kHeight};
  facts.left_deg = kLeft;
  facts.right_deg = kRight;
  return facts;
}
inline std::vector<Truth> two_sided_truths() {
  return {{"cantelaube_asymmetric_plus", vector({2})},
          {"cantelaube_asymmetric_friction", vector({36})},
          {"cantelaube_asymmetric_flanks", vector({0.55, 0.45})},
          {"cantelaube_asymmetric", vector({0.6, 0.4, 4, -0.25})}};
}

}  // namespace grainfield::coupling
