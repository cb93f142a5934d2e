#include "coupling/store/vtu.h"
#include "coupling/store/vtu_grid.h"

namespace grainfield::coupling {
namespace {

using Place = VtuGrid::Place;

// n x 2 or n x 3.
void add_points(const Eigen::MatrixXd& points, VtuGrid& grid) {
  for (const auto& at : points.rowwise()) {
    grid.add_point(at[0], at[1], points.cols() > 2 ? at[2] : 0);
  }
}

void add_triangles(const std::vector<std::array<int, 3>>& triangles, VtuGrid& grid) {
  for (const auto& corners : triangles) {
    grid.add_cell(VtuCell::triangle, {corners.begin(), corners.end()});
  }
}

void add_all(Place place, const std::vector<continuum::Quantity>& quantities, VtuGrid& grid) {
  for (const continuum::Quantity& q : quantities) grid.add_numbers(place, q.name, q.values);
}

}  // namespace

std::string triangles_vtu(const continuum::MeshField& mesh) {
  VtuGrid grid;
  add_points(mesh.corners, grid);
  add_triangles(mesh.triangles, grid);
  add_all(Place::points, mesh.at_corners, grid);
  add_all(Place::cells, mesh.in_triangles, grid);
  return grid.text();
}

std::string surface_vtu(const Eigen::MatrixXd& points,
                        const std::vector<std::array<int, 3>>& triangles,
                        const std::vector<continuum::Quantity>& at_points) {
  VtuGrid grid;
  add_points(points, grid);
  add_triangles(triangles, grid);
  add_all(Place::points, at_points, grid);
  return grid.text();
}

std::string lines_vtu(const std::vector<Eigen::MatrixXd>& lines) {
  VtuGrid grid;
  for (const Eigen::MatrixXd& line : lines) {
    std::vector<std::size_t> points;
    for (const auto& at : line.rowwise()) {
      if (at.allFinite()) points.push_back(grid.add_point(at[0], at[1]));
    }
    if (!points.empty()) grid.add_cell(VtuCell::poly_line, points);
  }
  const auto count = static_cast<Eigen::Index>(grid.cells());
  grid.add_numbers(Place::cells, "line",
                   Eigen::VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1)));
  return grid.text();
}

}  // namespace grainfield::coupling
