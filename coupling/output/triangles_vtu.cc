#include "coupling/output/triangles_vtu.h"

#include <fmt/format.h>

#include <stdexcept>

namespace grainfield::coupling {
namespace {

constexpr int kPolyLine = 4, kTriangle = 5;  // VTK's cell types

std::string piece(std::size_t points, std::size_t cells, const std::string& coordinates,
                  const std::string& connectivity, const std::string& offsets,
                  const std::string& types, const std::string& data) {
  const auto array = [](const char* type, const char* name, int components,
                        const std::string& text) {
    return fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n{}\n"
        "</DataArray>\n",
        type, name, components, text);
  };
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" "
      "NumberOfCells=\"{}\">\n<Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n{}</Piece>\n"
      "</UnstructuredGrid>\n</VTKFile>\n",
      points, cells, array("Float64", "Points", 3, coordinates),
      array("Int64", "connectivity", 1, connectivity), array("Int64", "offsets", 1, offsets),
      array("UInt8", "types", 1, types), data);
}

std::string data_of(const char* element, const std::vector<continuum::Quantity>& quantities,
                    std::size_t size) {
  std::string out = fmt::format("<{}>\n", element);
  for (const auto& quantity : quantities) {
    if (static_cast<std::size_t>(quantity.values.size()) != size)
      throw std::invalid_argument(fmt::format("triangles_vtu: {} has {} values, expected {}",
                                              quantity.name, quantity.values.size(), size));
    out +=
        fmt::format("<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n", quantity.name);
    for (const double v : quantity.values) out += fmt::format("{:.9g}\n", v);
    out += "</DataArray>\n";
  }
  return out + fmt::format("</{}>\n", element);
}

// A piece of points, three numbers a line, and triangles.
std::string triangle_piece(std::size_t points, const std::string& coordinates,
                           const std::vector<std::array<int, 3>>& triangles,
                           const std::string& data) {
  std::string connectivity, offsets, types;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& c = triangles[t];
    connectivity += fmt::format("{} {} {}\n", c[0], c[1], c[2]);
    offsets += fmt::format("{} ", 3 * (t + 1));
    types += fmt::format("{} ", kTriangle);
  }
  return piece(points, triangles.size(), coordinates, connectivity, offsets, types, data);
}

}  // namespace

std::string triangles_vtu(const continuum::MeshField& mesh) {
  std::string coordinates;
  for (const auto& at : mesh.corners.rowwise())
    coordinates += fmt::format("{:.9g} {:.9g} 0\n", at[0], at[1]);
  const auto points = static_cast<std::size_t>(mesh.corners.rows());
  return triangle_piece(points, coordinates, mesh.triangles,
                        data_of("PointData", mesh.at_corners, points) +
                            data_of("CellData", mesh.in_triangles, mesh.triangles.size()));
}

std::string surface_vtu(const Eigen::MatrixXd& points,
                        const std::vector<std::array<int, 3>>& triangles,
                        const std::vector<continuum::Quantity>& at_points) {
  std::string coordinates;
  for (const auto& at : points.rowwise())
    coordinates += fmt::format("{:.9g} {:.9g} {:.9g}\n", at[0], at[1], at[2]);
  const auto count = static_cast<std::size_t>(points.rows());
  return triangle_piece(count, coordinates, triangles, data_of("PointData", at_points, count));
}

std::string lines_vtu(const std::vector<Eigen::MatrixXd>& lines) {
  std::string coordinates, connectivity, offsets, types;
  std::size_t points = 0, cells = 0;
  continuum::Quantity number{"line", Eigen::VectorXd(lines.size())};
  for (const auto& line : lines) {
    const std::size_t before = points;
    for (const auto& at : line.rowwise()) {
      if (!at.allFinite()) continue;
      coordinates += fmt::format("{:.9g} {:.9g} 0\n", at[0], at[1]);
      connectivity += fmt::format("{} ", points++);
    }
    if (points == before) continue;
    offsets += fmt::format("{} ", points);
    types += fmt::format("{} ", kPolyLine);
    number.values[static_cast<Eigen::Index>(cells)] = static_cast<double>(cells);
    ++cells;
  }
  number.values.conservativeResize(static_cast<Eigen::Index>(cells));
  return piece(points, cells, coordinates, connectivity, offsets, types,
               data_of("CellData", {number}, cells));
}

}  // namespace grainfield::coupling
