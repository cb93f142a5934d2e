#include "coupling/export/field_vtu.h"

#include <fmt/format.h>

#include <iterator>
#include <vector>

#include "coupling/output/added_forces.h"

namespace grainfield::coupling {
namespace {

constexpr int kVertex = 1, kQuad = 9, kHexahedron = 12;  // VTK's cell types

struct Cells {
  std::vector<std::vector<long>> corners;
  int type = kVertex;
};

// Of a grid, points[ix + nx * (iy + ny * iz)].
Cells cells_of(const Field& field) {
  Cells out;
  const long nx = field.nx, ny = field.ny, nz = field.nz;
  if (nx < 2 || ny < 2) {
    for (long p = 0; p < field.points.rows(); ++p) out.corners.push_back({p});
    return out;
  }
  const bool space = nz > 1;
  out.type = space ? kHexahedron : kQuad;
  for (long iz = 0; iz < (space ? nz - 1 : 1); ++iz) {
    for (long iy = 0; iy + 1 < ny; ++iy) {
      for (long ix = 0; ix + 1 < nx; ++ix) {
        const long p = ix + nx * (iy + ny * iz);
        std::vector<long> corners = {p, p + 1, p + 1 + nx, p + nx};
        for (int k = 0; space && k < 4; ++k) corners.push_back(corners[k] + nx * ny);
        out.corners.push_back(std::move(corners));
      }
    }
  }
  return out;
}

void add_data(std::string& out, const std::string& name, const Eigen::VectorXd& values) {
  out += fmt::format("<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n", name);
  for (const double v : values) fmt::format_to(std::back_inserter(out), "{:.9g}\n", v);
  out += "</DataArray>\n";
}

}  // namespace

std::string field_vtu(const Field& field) {
  const Cells cells = cells_of(field);
  std::string points, connectivity, offsets, types, data;
  for (Eigen::Index p = 0; p < field.points.rows(); ++p) {
    const double z = field.points.cols() > 2 ? field.points(p, 2) : 0;
    fmt::format_to(std::back_inserter(points), "{:.9g} {:.9g} {:.9g}\n", field.points(p, 0),
                   field.points(p, 1), z);
  }
  std::size_t end = 0;
  for (const auto& corners : cells.corners) {
    for (const long corner : corners) connectivity += fmt::format("{} ", corner);
    offsets += fmt::format("{} ", end += corners.size());
    types += fmt::format("{} ", cells.type);
  }
  for (const Column& column : field.columns) {
    add_data(data, column.name, column.value);
    const bool errors = column.error.size() > 0 && !column.error.array().isNaN().all();
    if (errors) add_data(data, column.name + "_error", column.error);
  }
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<UnstructuredGrid>{}<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
      "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n"
      "{}</DataArray></Points>\n"
      "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">{}</DataArray>\n"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">{}</DataArray>\n"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">{}</DataArray></Cells>\n"
      "<PointData>\n{}</PointData>\n</Piece></UnstructuredGrid></VTKFile>\n",
      added_forces_in_vtk(field), field.points.rows(), cells.corners.size(), points, connectivity,
      offsets, types, data);
}

}  // namespace grainfield::coupling
