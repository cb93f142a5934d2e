#include "coupling/store/vtu_grid.h"

#include <fmt/format.h>

#include <iterator>
#include <stdexcept>

namespace grainfield::coupling {

std::size_t VtuGrid::add_point(double x, double y, double z) {
  fmt::format_to(std::back_inserter(coordinates_), "{:.9g} {:.9g} {:.9g}\n", x, y, z);
  return points_++;
}

void VtuGrid::add_cell(VtuCell type, const std::vector<std::size_t>& points) {
  for (const std::size_t p : points) connectivity_ += fmt::format("{} ", p);
  offsets_ += fmt::format("{} ", end_ += points.size());
  types_ += fmt::format("{} ", static_cast<int>(type));
  ++cells_;
}

void VtuGrid::add_data(Place place, const std::string& name, const char* type, int components,
                       const std::string& rows) {
  std::string& out = place == Place::points ? point_data_ : cell_data_;
  out += fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n"
      "{}</DataArray>\n",
      type, name, components, rows);
}

void VtuGrid::add_numbers(Place place, const std::string& name, const Eigen::VectorXd& values) {
  const std::size_t count = place == Place::points ? points_ : cells_;
  if (static_cast<std::size_t>(values.size()) != count) {
    throw std::invalid_argument(
        fmt::format("vtu: {} has {} values, expected {}", name, values.size(), count));
  }
  std::string rows;
  for (const double v : values) fmt::format_to(std::back_inserter(rows), "{:.9g}\n", v);
  add_data(place, name, "Float64", 1, rows);
}

std::string VtuGrid::text() const {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<UnstructuredGrid>{}<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
      "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n"
      "{}</DataArray></Points>\n"
      "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">{}</DataArray>\n"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">{}</DataArray>\n"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">{}</DataArray></Cells>\n"
      "<PointData>\n{}</PointData>\n<CellData>\n{}</CellData>\n"
      "</Piece></UnstructuredGrid></VTKFile>\n",
      field_data_, points_, cells_, coordinates_, connectivity_, offsets_, types_, point_data_,
      cell_data_);
}

}  // namespace grainfield::coupling
