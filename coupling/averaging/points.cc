#include "coupling/averaging/points.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "coupling/averaging/layer.h"
#include "coupling/averaging/region.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;

double between(double a, double b, int k, int n) { return n == 1 ? a : a + (b - a) * k / (n - 1); }

// y = intercept + slope x through the points.
struct Line {
  double slope = 0, intercept = 0;
  int points = 0;
};

Line fit(const std::vector<Vector2d>& points) {
  Line line;
  line.points = static_cast<int>(points.size());
  if (line.points < 2) return line;
  Vector2d mean(0, 0);
  for (const Vector2d& p : points) mean += p / static_cast<double>(points.size());
  double xx = 0, xy = 0;
  for (const Vector2d& p : points) {
    xx += (p.x() - mean.x()) * (p.x() - mean.x());
    xy += (p.x() - mean.x()) * (p.y() - mean.y());
  }
  line.slope = xy / xx;
  line.intercept = mean.y() - line.slope * mean.x();
  return line;
}

}  // namespace

MatrixXd line_points(double x0, double x1, int n, double y) {
  return grid_points(x0, x1, n, y, y, 1);
}

MatrixXd segment_points(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int n) {
  if (a.size() != b.size())
    throw std::invalid_argument(fmt::format(
        "a line from {} to {} coordinates; both ends need as many", a.size(), b.size()));
  if (n < 1) throw std::invalid_argument(fmt::format("a line of {} points; at least 1", n));
  MatrixXd points(n, a.size());
  for (int k = 0; k < n; ++k)
    for (Index c = 0; c < a.size(); ++c) points(k, c) = between(a[c], b[c], k, n);
  return points;
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

MatrixXd HeapFrame::to_packing(const MatrixXd& scaled) const {
  return (height * scaled).rowwise() + Eigen::RowVector2d(apex_x, floor + height);
}

MatrixXd HeapFrame::to_scaled(const MatrixXd& packing_points) const {
  return (packing_points.rowwise() - Eigen::RowVector2d(apex_x, floor + height)) / height;
}

HeapFrame heap_frame(const dem::Snapshot& snapshot) {
  if (snapshot.dim != 2) throw std::invalid_argument("the snapshot is 3D; a 2D one is needed");
  const Region region(snapshot);
  HeapFrame frame;
  frame.floor = region.floor();
  frame.left = region.left();
  frame.right = region.right();
  frame.height = region.highest() - region.floor();
  double top_x = 0;
  for (const Vector2d& corner : region.corners())
    if (corner.y() == region.highest()) top_x = corner.x();
  frame.apex_x = top_x;
  std::vector<Vector2d> left, right;
  for (const Vector2d& corner : region.corners()) {
    const double y = (corner.y() - frame.floor) / frame.height;
    if (y > 0.15 && y < 0.85) (corner.x() < top_x ? left : right).push_back(corner);
  }
  const Line l = fit(left), r = fit(right);
  frame.left_slope = l.slope;
  frame.right_slope = -r.slope;
  if (l.points < 2 || r.points < 2 || !(l.slope > r.slope)) return frame;
  const double x = (r.intercept - l.intercept) / (l.slope - r.slope);
  if (x > frame.left && x < frame.right) frame.apex_x = x;
  return frame;
}

}  // namespace grainfield::coupling
