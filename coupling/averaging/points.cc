#include "coupling/averaging/points.h"

#include <fmt/format.h>

#include <stdexcept>

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;

double between(double a, double b, int k, int n) { return n == 1 ? a : a + (b - a) * k / (n - 1); }

}  // namespace

MatrixXd line_points(double x0, double x1, int n, double y) {
  return grid_points(x0, x1, n, y, y, 1);
}

MatrixXd grid_points(double x0, double x1, int nx, double y0, double y1, int ny) {
  if (nx < 1 || ny < 1)
    throw std::invalid_argument(fmt::format("a grid of {} x {} points; at least 1 x 1", nx, ny));
  MatrixXd points(static_cast<Index>(nx) * ny, 2);
  for (int iy = 0; iy < ny; ++iy)
    for (int ix = 0; ix < nx; ++ix) {
      const Index row = ix + static_cast<Index>(nx) * iy;
      points(row, 0) = between(x0, x1, ix, nx);
      points(row, 1) = between(y0, y1, iy, ny);
    }
  return points;
}

MatrixXd cut_points(double x0, double x1, int n, const std::vector<double>& heights) {
  if (heights.empty()) throw std::invalid_argument("horizontal cuts without heights");
  MatrixXd points(static_cast<Index>(heights.size()) * n, 2);
  for (std::size_t k = 0; k < heights.size(); ++k)
    points.middleRows(static_cast<Index>(k) * n, n) = line_points(x0, x1, n, heights[k]);
  return points;
}

MatrixXd box_points(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int nx, int ny,
                    int nz) {
  if (nx < 1 || ny < 1 || nz < 1)
    throw std::invalid_argument(
        fmt::format("a grid of {} x {} x {} points; at least 1 x 1 x 1", nx, ny, nz));
  std::vector<double> heights;
  for (int iz = 0; iz < nz; ++iz) heights.push_back(between(low.z(), high.z(), iz, nz));
  return cut_points(low.head<2>(), high.head<2>(), nx, ny, heights);
}

MatrixXd cut_points(const Vector2d& low, const Vector2d& high, int nx, int ny,
                    const std::vector<double>& heights) {
  if (heights.empty()) throw std::invalid_argument("horizontal cuts without heights");
  const MatrixXd plane = grid_points(low.x(), high.x(), nx, low.y(), high.y(), ny);
  MatrixXd points(static_cast<Index>(heights.size()) * plane.rows(), 3);
  for (std::size_t k = 0; k < heights.size(); ++k) {
    auto rows = points.middleRows(static_cast<Index>(k) * plane.rows(), plane.rows());
    rows.leftCols(2) = plane;
    rows.col(2).setConstant(heights[k]);
  }
  return points;
}

}  // namespace grainfield::coupling
