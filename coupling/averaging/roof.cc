#include "coupling/averaging/roof.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/averaging/columns.h"
#include "coupling/averaging/extent.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;

constexpr double kMostColumns = 1e7;  // of a roof

// The columns between whose middles t lies (in columns from the first edge), and how far along.
struct Between {
  Index first, second;
  double share;
};

Between between(double t, Index n) {
  const double at = std::clamp(t - 0.5, 0.0, static_cast<double>(n - 1));
  const auto first = std::min(static_cast<Index>(at), std::max<Index>(n - 2, 0));
  return {first, std::min(first + 1, n - 1), at - static_cast<double>(first)};
}

}  // namespace

Roof::Roof(double height) : heights_(Eigen::MatrixXd::Constant(1, 1, height)), mean_(height) {}

Roof::Roof(const dem::Snapshot& snapshot, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
           double column)
    : low_(low.head<2>()) {
  Index n[2];
  for (int a = 0; a < 2; ++a) {
    const double most = a == 0 ? 1e6 : kMostColumns / static_cast<double>(n[0]);
    n[a] = static_cast<Index>(count_columns(snapshot, a, low[a], high[a], column, most));
    size_[a] = (high[a] - low[a]) / static_cast<double>(n[a]);
  }
  constexpr double none = -std::numeric_limits<double>::infinity();
  heights_ = Eigen::MatrixXd::Constant(n[0], n[1], none);
  for (const dem::Grain& grain : snapshot.grains) {
    if (grain.fixed) continue;
    Index k[2];
    for (int a = 0; a < 2; ++a)
      k[a] = static_cast<Index>(std::clamp(std::floor((grain.position[a] - low_[a]) / size_[a]),
                                           0.0, static_cast<double>(n[a] - 1)));
    heights_(k[0], k[1]) = std::max(heights_(k[0], k[1]), top_of(grain, 3));
  }
  double sum = 0;
  int filled = 0;
  for (Index k = 0; k < heights_.size(); ++k) {
    double& height = heights_.data()[k];
    if (height > none) {
      sum += height;
      ++filled;
    }
    height = std::max(height, low.z());
  }
  mean_ = sum / filled;
}

double Roof::height(double x, double y) const {
  const Between i = between((x - low_.x()) / size_.x(), heights_.rows()),
                j = between((y - low_.y()) / size_.y(), heights_.cols());
  const auto along = [&](Index column) {
    return (1 - i.share) * heights_(i.first, column) + i.share * heights_(i.second, column);
  };
  return (1 - j.share) * along(j.first) + j.share * along(j.second);
}

double Roof::lowest(double x0, double x1, double y0, double y1) const {
  const Index rows = heights_.rows(), columns = heights_.cols();
  const Index i0 = between((x0 - low_.x()) / size_.x(), rows).first,
              i1 = between((x1 - low_.x()) / size_.x(), rows).second,
              j0 = between((y0 - low_.y()) / size_.y(), columns).first,
              j1 = between((y1 - low_.y()) / size_.y(), columns).second;
  return heights_.block(i0, j0, i1 - i0 + 1, j1 - j0 + 1).minCoeff();
}

Eigen::Vector2d Roof::middle(Index column_x, Index column_y) const {
  return {low_.x() + (static_cast<double>(column_x) + 0.5) * size_.x(),
          low_.y() + (static_cast<double>(column_y) + 0.5) * size_.y()};
}

}  // namespace grainfield::coupling
