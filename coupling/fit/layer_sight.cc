#include "coupling/fit/layer_sight.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace grainfield::coupling {
namespace {

constexpr double kMostWave = 100;    // u: what is beyond is smoothed away
constexpr double kLeastWave = 1e-3;  // instead of u = 0, where the base's conditions degenerate
constexpr double kFarther = 24;      // distance of the periodic images from the points, in h
constexpr double kOnBase = 1e-9;

using Across = boost::math::quadrature::gauss<double, 48>;
using Down = boost::math::quadrature::gauss<double, 10>;

// Nodes and weights of Gauss-Legendre on [from, to].
template <class Rule>
void add_panel(double from, double to, std::vector<std::pair<double, double>>& out) {
  const double half = 0.5 * (to - from), middle = 0.5 * (to + from);
  for (std::size_t k = 0; k < Rule::abscissa().size(); ++k) {
    const double a = Rule::abscissa()[k], w = Rule::weights()[k] * half;
    out.emplace_back(middle + half * a, w);
    if (a > 0) out.emplace_back(middle - half * a, w);
  }
}

std::vector<PointSet> points_one_by_one(const Eigen::MatrixXd& points, const Kernel& kernel) {
  std::vector<PointSet> out;
  for (const auto& point : points.rowwise()) {
    const bool base = std::fabs(point[1] + 1) < kOnBase;
    out.push_back({point, base ? Smoothing::marginal : Smoothing::kernel, &kernel});
  }
  return out;
}

}  // namespace

LayerSight::LayerSight(const Eigen::MatrixXd& points, const Kernel& kernel)
    : places_(points),
      layer_(points_one_by_one(points, kernel), 1),
      half_plane_(points_one_by_one(points, kernel), 0) {
  make_levels(points, kernel);
}

// A kernel w(|r|) at the depth d weighs the depth d + e with the transform of its profile across,
//   Int w(sqrt(z^2 + e^2)) cos(k z) dz,
// and on the base with that of its marginal.
void LayerSight::make_levels(const Eigen::MatrixXd& points, const Kernel& kernel) {
  const double reach = kernel.range();
  const double step = 2 * std::numbers::pi / (2 * points.col(0).cwiseAbs().maxCoeff() + kFarther);
  const auto n = static_cast<Eigen::Index>(kMostWave / step) + 1;
  waves_ = Eigen::VectorXd::LinSpaced(n, 0, step * static_cast<double>(n - 1));
  measure_ = Eigen::VectorXd::Constant(n, step / std::numbers::pi);
  measure_[0] *= 0.5;
  cosine_.resize(points.rows(), n);
  sine_.resize(points.rows(), n);
  for (Eigen::Index k = 0; k < n; ++k) {
    cosine_.col(k) = (waves_[k] * points.col(0)).array().cos();
    sine_.col(k) = (waves_[k] * points.col(0)).array().sin();
  }
  std::map<double, std::vector<Eigen::Index>> by_height;
  for (Eigen::Index p = 0; p < points.rows(); ++p) by_height[points(p, 1)].push_back(p);
  std::vector<double> shares;
  for (const auto& [y, rows] : by_height) {
    Level level;
    level.points = rows;
    level.first = static_cast<Eigen::Index>(shares.size());
    std::vector<std::pair<double, double>> across;
    if (std::fabs(y + 1) < kOnBase) {
      level.count = 1;
      shares.push_back(1);
      add_panel<Across>(0, reach, across);
      level.weight.setZero(n, 1);
      for (const auto& [z, w] : across) {
        level.weight.col(0).array() += 2 * w * kernel.marginal(z) * (waves_.array() * z).cos();
      }
      level.weight /= level.weight(0, 0);
    } else {
      // Panels end where the field or its continuation has a kink: the surface and the base.
      const double depth = -y;
      std::vector<double> ends{std::max(depth - reach, 0.0), std::min(depth + reach, 1.0)};
      if (depth + reach > 1) ends.push_back(depth + reach);
      std::vector<std::pair<double, double>> down;
      for (std::size_t k = 0; k + 1 < ends.size(); ++k) add_panel<Down>(ends[k], ends[k + 1], down);
      level.count = static_cast<Eigen::Index>(down.size());
      level.weight.setZero(n, level.count);
      for (Eigen::Index k = 0; k < level.count; ++k) {
        const auto& [at, weight] = down[static_cast<std::size_t>(k)];
        const double off = at - depth, half = std::sqrt(std::max(0.0, reach * reach - off * off));
        shares.push_back(std::min(at, 1.0));
        across.clear();
        add_panel<Across>(0, half, across);
        for (const auto& [z, w] : across) {
          level.weight.col(k).array() +=
              2 * w * weight * kernel.value(std::hypot(z, off)) * (waves_.array() * z).cos();
        }
      }
    }
    levels_.push_back(std::move(level));
  }
  shares_ = Eigen::Map<Eigen::VectorXd>(shares.data(), static_cast<Eigen::Index>(shares.size()));
}

Eigen::MatrixXd LayerSight::seen(const continuum::OrthotropicWaves& waves) const {
  const auto n = waves_.size();
  std::vector<Eigen::MatrixX3d> spectra(levels_.size(), Eigen::MatrixX3d(n, 3));
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::MatrixX3d g = waves.total(std::max(waves_[k], kLeastWave), shares_);
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      const Level& level = levels_[l];
      spectra[l].row(k) =
          measure_[k] * (level.weight.row(k) * g.middleRows(level.first, level.count));
    }
  }
  Eigen::MatrixXd out(cosine_.rows(), 3);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    for (const Eigen::Index p : levels_[l].points) {
      out(p, 0) = cosine_.row(p) * spectra[l].col(0);
      out(p, 1) = -cosine_.row(p) * spectra[l].col(1);
      out(p, 2) = -sine_.row(p) * spectra[l].col(2);
    }
  }
  return out;
}

}  // namespace grainfield::coupling
