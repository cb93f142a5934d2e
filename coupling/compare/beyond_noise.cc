#include "coupling/compare/beyond_noise.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace grainfield::coupling {
namespace {

constexpr double kSide = 0.95;

struct SquaredMisfit {
  double beyond = kNan, noise = kNan;
};

SquaredMisfit squared_misfit(const Eigen::MatrixXd& samples, const Eigen::VectorXd& model) {
  const auto n = static_cast<double>(samples.cols());
  const Eigen::VectorXd mean = samples.rowwise().mean();
  const double scale = model.squaredNorm();
  const double noise = (samples.colwise() - mean).squaredNorm() / (n * (n - 1)) / scale;
  return {(mean - model).squaredNorm() / scale - noise, noise};
}

}  // namespace

double BeyondNoise::right_to() const {
  return degrees > 0 ? std::sqrt(std::max(0.0, bound)) : kNan;
}

BeyondNoise misfit_beyond_noise(const Eigen::MatrixXd& samples, const Eigen::VectorXd& model) {
  if (samples.rows() != model.size())
    throw std::invalid_argument("misfit beyond noise: the model has other places than the samples");
  std::vector<Eigen::Index> whole;
  for (Eigen::Index k = 0; k < model.size(); ++k) {
    if (samples.row(k).allFinite() && std::isfinite(model[k])) whole.push_back(k);
  }
  const auto n = samples.cols();
  BeyondNoise out;
  if (n < 2 || whole.empty()) return out;
  const Eigen::MatrixXd all = samples(whole, Eigen::all);
  const Eigen::VectorXd at = model(whole);
  const SquaredMisfit value = squared_misfit(all, at);
  out.squared = value.beyond;
  out.noise = value.noise;
  if (n < 3) return out;  // without one there is no noise to take away
  Eigen::ArrayXd without(n);
  for (Eigen::Index r = 0; r < n; ++r) {
    Eigen::MatrixXd others(all.rows(), n - 1);
    others << all.leftCols(r), all.rightCols(n - 1 - r);
    without[r] = squared_misfit(others, at).beyond;
  }
  const auto count = static_cast<double>(n);
  out.error = std::sqrt((count - 1) / count * (without - without.mean()).square().sum());
  out.degrees = static_cast<int>(n) - 1;
  // The jackknife knows little of the scatter where the misfit is noise: that of a single mode,
  // which no noise of this size exceeds, is added.
  const double scatter = std::hypot(out.error, std::numbers::sqrt2 * out.noise);
  out.bound =
      out.squared + scatter * boost::math::quantile(boost::math::students_t(count - 1), kSide);
  return out;
}

}  // namespace grainfield::coupling
