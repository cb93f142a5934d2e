// Points sorted into cubic cells, so that a grain or contact meets only the points near it.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace grainfield::coupling {

template <int D>
class PointCells {
 public:
  using Vector = Eigen::Matrix<double, D, 1>;

  /// Cells of the points [first, last) of `points`; `cell`: side, m, made larger while there
  /// would be more cells than about four per point.
  PointCells(const Eigen::MatrixXd& points, Eigen::Index first, Eigen::Index last, double cell)
      : cell_(cell) {
    if (first == last) return;
    const auto block = points.middleRows(first, last - first);
    low_ = block.colwise().minCoeff().transpose();
    const Vector size = block.colwise().maxCoeff().transpose() - low_;
    const auto cells = [&] {
      double product = 1;
      for (int a = 0; a < D; ++a) product *= std::floor(size[a] / cell_) + 1;
      return product;
    };
    while (cells() > 4 * static_cast<double>(last - first) + 1) cell_ *= 1.25;
    for (int a = 0; a < D; ++a)
      n_[static_cast<std::size_t>(a)] = static_cast<int>(size[a] / cell_) + 1;
    start_.assign(static_cast<std::size_t>(cells()) + 1, 0);
    for (Eigen::Index p = first; p < last; ++p) ++start_[cell_of(points, p) + 1];
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    order_.resize(static_cast<std::size_t>(last - first));
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (Eigen::Index p = first; p < last; ++p) order_[next[cell_of(points, p)]++] = p;
  }

  /// Calls visit(point index) for every point in the cells that meet the box.
  template <class Visit>
  void near(const Vector& low, const Vector& high, Visit&& visit) const {
    if (order_.empty()) return;
    std::array<int, 3> from{0, 0, 0}, to{0, 0, 0};
    for (int a = 0; a < D; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const double f = (low[a] - low_[a]) / cell_, t = (high[a] - low_[a]) / cell_;
      if (t < 0 || f >= n_[axis]) return;
      from[axis] = f > 0 ? static_cast<int>(f) : 0;
      to[axis] = t >= n_[axis] ? n_[axis] - 1 : static_cast<int>(t);
    }
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y) {
        const std::size_t row = (static_cast<std::size_t>(z) * static_cast<std::size_t>(n_[1]) +
                                 static_cast<std::size_t>(y)) *
                                static_cast<std::size_t>(n_[0]);
        const std::size_t begin = start_[row + static_cast<std::size_t>(from[0])];
        const std::size_t end = start_[row + static_cast<std::size_t>(to[0]) + 1];
        for (std::size_t k = begin; k < end; ++k) visit(order_[k]);
      }
  }

 private:
  std::size_t cell_of(const Eigen::MatrixXd& points, Eigen::Index p) const {
    std::size_t cell = 0;
    for (int a = D - 1; a >= 0; --a) {
      const auto axis = static_cast<std::size_t>(a);
      const int k = std::min(static_cast<int>((points(p, a) - low_[a]) / cell_), n_[axis] - 1);
      cell = cell * static_cast<std::size_t>(n_[axis]) + static_cast<std::size_t>(k);
    }
    return cell;
  }

  Vector low_ = Vector::Zero();
  double cell_ = 1;
  std::array<int, 3> n_{1, 1, 1};
  std::vector<std::size_t> start_;
  std::vector<Eigen::Index> order_;
};

}  // namespace grainfield::coupling
