#include "coupling/export/forms.h"
#include "coupling/store/added_forces.h"
#include "coupling/store/vtu_grid.h"

namespace grainfield::coupling {
namespace {

// Cells of a grid, between points[ix + nx * (iy + ny * iz)]; a point is a cell in other fields.
void add_cells(const Field& field, VtuGrid& grid) {
  const auto nx = static_cast<std::size_t>(field.nx), ny = static_cast<std::size_t>(field.ny),
             nz = static_cast<std::size_t>(field.nz);
  if (nx < 2 || ny < 2) {
    for (std::size_t p = 0; p < grid.points(); ++p) grid.add_cell(VtuCell::vertex, {p});
    return;
  }
  const bool space = nz > 1;
  for (std::size_t iz = 0; iz < (space ? nz - 1 : 1); ++iz) {
    for (std::size_t iy = 0; iy + 1 < ny; ++iy) {
      for (std::size_t ix = 0; ix + 1 < nx; ++ix) {
        const std::size_t p = ix + nx * (iy + ny * iz);
        std::vector<std::size_t> corners = {p, p + 1, p + 1 + nx, p + nx};
        for (std::size_t k = 0; space && k < 4; ++k) corners.push_back(corners[k] + nx * ny);
        grid.add_cell(space ? VtuCell::hexahedron : VtuCell::quad, corners);
      }
    }
  }
}

}  // namespace

std::string field_vtu(const Field& field) {
  VtuGrid grid;
  for (const auto& at : field.points.rowwise()) {
    grid.add_point(at[0], at[1], field.points.cols() > 2 ? at[2] : 0);
  }
  add_cells(field, grid);
  for (const Column& column : field.columns) {
    grid.add_numbers(VtuGrid::Place::points, column.name, column.value);
    const bool errors = column.error.size() > 0 && !column.error.array().isNaN().all();
    if (errors) grid.add_numbers(VtuGrid::Place::points, column.name + "_error", column.error);
  }
  grid.set_field_data(added_forces_in_vtk(field));
  return grid.text();
}

}  // namespace grainfield::coupling
