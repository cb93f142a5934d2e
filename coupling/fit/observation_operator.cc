#include "coupling/fit/observation_operator.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace grainfield::coupling {
namespace {

constexpr double kMostWave = 100;    // u: what is beyond is smoothed away
constexpr double kLeastWave = 1e-3;  // instead of u = 0, where the base's conditions degenerate
constexpr double kFarther = 24;      // distance of the periodic images from the points, in h
constexpr double kOnBase = 1e-9;
constexpr int kHeapRings = 3;  // of the quadrature; heaps have kinks, no singularity

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

}  // namespace

ObservationOperator::ObservationOperator(const Eigen::MatrixXd& points) : points_(points) {
  for (Eigen::Index k = 0; k < points.rows(); ++k) row_[{points(k, 0), points(k, 1)}] = k;
}

ObservationOperator::ObservationOperator(const Eigen::MatrixXd& points, const Kernel& kernel)
    : ObservationOperator(points) {
  layer_ = layer_nodes(kernel, 1);
  half_plane_ = layer_nodes(kernel, 0);
  make_levels(kernel);
}

ObservationOperator ObservationOperator::of_heap(const Eigen::MatrixXd& points,
                                                 const Kernel& kernel, double depth) {
  ObservationOperator out(points);
  out.layer_ = out.nodes_of([&](const StressFunction& stress, const Eigen::MatrixXd& here) {
    return smooth_in_plane(stress, here, kernel, depth, kHeapRings);
  });
  return out;
}

ObservationOperator ObservationOperator::of_cells(const Eigen::MatrixXd& points,
                                                  const Kernel& kernel) {
  ObservationOperator out(points);
  out.layer_ = out.nodes_of([&](const StressFunction& stress, const Eigen::MatrixXd& here) {
    return smooth_along_x(stress, here, kernel);
  });
  return out;
}

ObservationOperator::Nodes ObservationOperator::layer_nodes(const Kernel& kernel,
                                                            double depth) const {
  return nodes_of([&](const StressFunction& stress, const Eigen::MatrixXd& here) {
    const bool base = std::fabs(here(0, 1) + 1) < kOnBase;
    return base ? smooth_along_x(stress, here, kernel)
                : smooth_in_plane(stress, here, kernel, depth);
  });
}

// The smoothing is linear: the identity as "stress" at a point's nodes gives their weights.
ObservationOperator::Nodes ObservationOperator::nodes_of(const Smoothing& smooth) const {
  std::vector<Eigen::MatrixXd> parts;
  std::vector<Eigen::Triplet<double>> weights;
  Eigen::Index total = 0;
  for (Eigen::Index p = 0; p < points_.rows(); ++p) {
    const StressFunction identity = [&](const Eigen::MatrixXd& nodes) -> Eigen::MatrixXd {
      parts.push_back(nodes);
      return Eigen::MatrixXd::Identity(nodes.rows(), nodes.rows());
    };
    const Eigen::MatrixXd row = smooth(identity, points_.row(p));
    for (Eigen::Index k = 0; k < row.cols(); ++k) {
      if (row(0, k) != 0) {
        weights.emplace_back(static_cast<int>(p), static_cast<int>(total + k), row(0, k));
      }
    }
    total += row.cols();
  }
  Nodes out;
  out.at.resize(total, 2);
  Eigen::Index first = 0;
  for (const Eigen::MatrixXd& part : parts) {
    out.at.middleRows(first, part.rows()) = part;
    first += part.rows();
  }
  out.weight.resize(points_.rows(), total);
  out.weight.setFromTriplets(weights.begin(), weights.end());
  return out;
}

// A kernel w(|r|) at the depth d weighs the depth d + e with the transform of its profile across,
//   Int w(sqrt(z^2 + e^2)) cos(k z) dz,
// and on the base with that of its marginal.
void ObservationOperator::make_levels(const Kernel& kernel) {
  const double reach = kernel.range();
  const double step = 2 * std::numbers::pi / (2 * points_.col(0).cwiseAbs().maxCoeff() + kFarther);
  const auto n = static_cast<Eigen::Index>(kMostWave / step) + 1;
  waves_ = Eigen::VectorXd::LinSpaced(n, 0, step * static_cast<double>(n - 1));
  measure_ = Eigen::VectorXd::Constant(n, step / std::numbers::pi);
  measure_[0] *= 0.5;
  cosine_.resize(points_.rows(), n);
  sine_.resize(points_.rows(), n);
  for (Eigen::Index k = 0; k < n; ++k) {
    cosine_.col(k) = (waves_[k] * points_.col(0)).array().cos();
    sine_.col(k) = (waves_[k] * points_.col(0)).array().sin();
  }
  std::map<double, std::vector<Eigen::Index>> by_height;
  for (Eigen::Index p = 0; p < points_.rows(); ++p) by_height[points_(p, 1)].push_back(p);
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

Eigen::MatrixXd ObservationOperator::seen(const StressFunction& stress, bool half_plane) const {
  const Nodes& nodes = half_plane ? half_plane_ : layer_;
  return nodes.weight * stress(nodes.at);
}

Eigen::MatrixXd ObservationOperator::seen_in_heap(const StressFunction& stress) const {
  const Eigen::MatrixXd exact = stress(points_);
  Eigen::MatrixXd out =
      layer_.weight * stress(layer_.at).unaryExpr([](double v) { return std::isnan(v) ? 0.0 : v; });
  for (Eigen::Index p = 0; p < out.rows(); ++p) {
    if (!exact.row(p).allFinite()) out.row(p).setConstant(std::nan(""));
  }
  return out;
}

Eigen::MatrixXd ObservationOperator::seen(const continuum::OrthotropicWaves& waves) const {
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
  Eigen::MatrixXd out(points_.rows(), 3);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    for (const Eigen::Index p : levels_[l].points) {
      out(p, 0) = cosine_.row(p) * spectra[l].col(0);
      out(p, 1) = -cosine_.row(p) * spectra[l].col(1);
      out(p, 2) = -sine_.row(p) * spectra[l].col(2);
    }
  }
  return out;
}

Eigen::MatrixXd ObservationOperator::pick(const Eigen::MatrixXd& values,
                                          const Eigen::MatrixXd& points) const {
  if (points.rows() == points_.rows() && points == points_) return values;
  Eigen::MatrixXd out(points.rows(), values.cols());
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const auto at = row_.find({points(k, 0), points(k, 1)});
    if (at == row_.end())
      throw std::logic_error("ObservationOperator: a point that it does not know");
    out.row(k) = values.row(at->second);
  }
  return out;
}

FitModel seen_through(FitModel model, std::shared_ptr<const ObservationOperator> seeing) {
  model.stress = [exact = std::move(model.stress), seeing = std::move(seeing)](
                     const Eigen::MatrixXd& points, const Eigen::VectorXd& parameters) {
    const StressFunction stress = [&](const Eigen::MatrixXd& nodes) {
      return exact(nodes, parameters);
    };
    return seeing->pick(seeing->seen_in_heap(stress), points);
  };
  return model;
}

}  // namespace grainfield::coupling
