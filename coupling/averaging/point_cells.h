// Points sorted into square cells, so that a grain or contact meets only the points near it.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace grainfield::coupling {

class PointCells {
 public:
  /// Of the points [first, last) of `points`; `cell`: side of a cell, m, made larger if there would
  /// be more cells than about four per point.
  PointCells(const Eigen::MatrixXd& points, Eigen::Index first, Eigen::Index last, double cell) {
    if (first == last) return;
    const auto block = points.middleRows(first, last - first);
    low_ = block.colwise().minCoeff().transpose();
    const Eigen::Vector2d size = block.colwise().maxCoeff().transpose() - low_;
    const double count = static_cast<double>(last - first);
    cell_ = std::max(
        {cell, std::sqrt(size.x() * size.y() / (4 * count)), (size.x() + size.y()) / (4 * count)});
    nx_ = static_cast<int>(size.x() / cell_) + 1;
    ny_ = static_cast<int>(size.y() / cell_) + 1;
    start_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_) + 1, 0);
    for (Eigen::Index p = first; p < last; ++p) ++start_[cell_of(points, p) + 1];
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    order_.resize(static_cast<std::size_t>(last - first));
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (Eigen::Index p = first; p < last; ++p) order_[next[cell_of(points, p)]++] = p;
  }

  /// Calls visit(point index) for every point in the cells that meet the box.
  template <class Visit>
  void near(const Eigen::Vector2d& low, const Eigen::Vector2d& high, Visit&& visit) const {
    if (order_.empty()) return;
    const Eigen::Vector2d from = (low - low_) / cell_, to = (high - low_) / cell_;
    if (to.x() < 0 || to.y() < 0 || from.x() >= nx_ || from.y() >= ny_) return;
    const int x0 = std::max(0, static_cast<int>(std::max(0.0, from.x())));
    const int y0 = std::max(0, static_cast<int>(std::max(0.0, from.y())));
    const int x1 = to.x() >= nx_ ? nx_ - 1 : static_cast<int>(to.x());
    const int y1 = to.y() >= ny_ ? ny_ - 1 : static_cast<int>(to.y());
    for (int y = y0; y <= y1; ++y) {
      const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_);
      const std::size_t begin = start_[row + static_cast<std::size_t>(x0)];
      const std::size_t end = start_[row + static_cast<std::size_t>(x1) + 1];
      for (std::size_t k = begin; k < end; ++k) visit(order_[k]);
    }
  }

 private:
  std::size_t cell_of(const Eigen::MatrixXd& points, Eigen::Index p) const {
    const auto x = static_cast<int>((points(p, 0) - low_.x()) / cell_);
    const auto y = static_cast<int>((points(p, 1) - low_.y()) / cell_);
    return static_cast<std::size_t>(std::min(y, ny_ - 1)) * static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(std::min(x, nx_ - 1));
  }

  Eigen::Vector2d low_{0, 0};
  double cell_ = 1;
  int nx_ = 0, ny_ = 0;
  std::vector<std::size_t> start_;
  std::vector<Eigen::Index> order_;
};

}  // namespace grainfield::coupling
