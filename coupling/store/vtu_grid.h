// An unstructured grid of VTK in the making: every .vtu file is the text of one.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace grainfield::coupling {

/// VTK's numbers of cell types.
enum class VtuCell {
  vertex = 1,
  line = 3,
  poly_line = 4,
  triangle = 5,
  strip = 6,
  polygon = 7,
  quad = 9,
  hexahedron = 12
};

class VtuGrid {
 public:
  enum class Place { points, cells };

  /// The number of the point, from 0.
  std::size_t add_point(double x, double y, double z = 0);
  /// A cell of points that are there.
  void add_cell(VtuCell type, const std::vector<std::size_t>& points);
  std::size_t points() const { return points_; }
  std::size_t cells() const { return cells_; }

  /// A line of `rows` for each point or cell; `type` and `components` as VTK names them.
  void add_data(Place place, const std::string& name, const char* type, int components,
                const std::string& rows);
  /// A number for each. Throws std::invalid_argument naming the data for another count of them.
  void add_numbers(Place place, const std::string& name, const Eigen::VectorXd& values);

  /// A <FieldData> of the whole grid, as added_forces_in_vtk writes it; empty: none.
  void set_field_data(std::string text) { field_data_ = std::move(text); }

  /// The ASCII file.
  std::string text() const;

 private:
  std::string coordinates_, connectivity_, offsets_, types_, point_data_, cell_data_, field_data_;
  std::size_t points_ = 0, cells_ = 0, end_ = 0;
};

}  // namespace grainfield::coupling
