#include "coupling/output/vtu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coupling/output/atomic_file.h"

namespace grainfield::coupling {
namespace {

// VTK's cell types.
constexpr int vtk_line = 3, vtk_polygon = 7, vtk_quad = 9;

/// An unstructured grid in the making: cells that share no points.
class Grid {
 public:
  void add_cell(const std::vector<dem::Vec3>& corners, int type) {
    for (const dem::Vec3& c : corners)
      fmt::format_to(std::back_inserter(points_), "{:.9g} {:.9g} {:.9g}\n", c.x(), c.y(), c.z());
    for (std::size_t k = 0; k < corners.size(); ++k) connectivity_ += fmt::format("{} ", count_++);
    offsets_ += fmt::format("{} ", count_);
    types_ += fmt::format("{} ", type);
    ++cells_;
  }

  /// `of` gives the text of cell k's value.
  template <class Of>
  void add_data(const std::string& name, const char* type, int components, Of&& of) {
    data_ += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", type,
        name, components);
    for (std::size_t k = 0; k < cells_; ++k) data_ += of(k) + "\n";
    data_ += "</DataArray>\n";
  }
  template <class Of>
  void add_number(const std::string& name, Of&& of) {
    add_data(name, "Float64", 1,
             [&](std::size_t k) { return fmt::format("{:.9g}", double(of(k))); });
  }
  template <class Of>
  void add_integer(const std::string& name, Of&& of) {
    add_data(name, "Int64", 1,
             [&](std::size_t k) { return fmt::format("{}", std::int64_t(of(k))); });
  }
  template <class Of>
  void add_vector(const std::string& name, Of&& of) {
    add_data(name, "Float64", 3, [&](std::size_t k) {
      const dem::Vec3 v = of(k);
      return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z());
    });
  }

  void write(const std::string& file) const {
    write_text_file(
        file,
        fmt::format(
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
            "<UnstructuredGrid><Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
            "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n"
            "{}</DataArray></Points>\n"
            "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" "
            "format=\"ascii\">{}</DataArray>\n"
            "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">{}</DataArray>\n"
            "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">{}</DataArray></Cells>\n"
            "<CellData>\n{}</CellData>\n</Piece></UnstructuredGrid></VTKFile>\n",
            count_, cells_, points_, connectivity_, offsets_, types_, data_));
  }

 private:
  std::string points_, connectivity_, offsets_, types_, data_;
  std::size_t count_ = 0, cells_ = 0;
};

const dem::Grain& grain(const dem::Snapshot& snapshot, std::int64_t index) {
  return snapshot.grains[static_cast<std::size_t>(index)];
}

// From the centre of i to the centre of j, or to the contact point on a wall.
dem::Vec3 branch_end(const dem::Snapshot& snapshot, const dem::Contact& contact) {
  return contact.j >= 0 ? grain(snapshot, contact.j).position : contact.point;
}

}  // namespace

std::vector<dem::Vec3> outline(const dem::Grain& grain, int sides) {
  std::vector<dem::Vec3> corners;
  const double c = std::cos(grain.angle), s = std::sin(grain.angle);
  for (const auto& [x, y] : grain.outline)
    corners.push_back(grain.position + dem::Vec3(c * x - s * y, s * x + c * y, 0));
  if (!corners.empty()) return corners;
  for (int k = 0; k < sides; ++k) {
    const double a = grain.angle + 2 * std::numbers::pi * k / sides;
    corners.push_back(grain.position + grain.radius * dem::Vec3(std::cos(a), std::sin(a), 0));
  }
  return corners;
}

void write_grains_vtu(const std::string& file, const dem::Snapshot& snapshot,
                      const dem::Snapshot* reference) {
  const std::vector<dem::Grain>& grains = snapshot.grains;
  if (reference && reference->grains.size() != grains.size())
    throw std::invalid_argument(
        fmt::format("snapshots do not belong together: {} grains and {} in the reference",
                    grains.size(), reference->grains.size()));
  std::vector<int> coordination(grains.size(), 0);
  std::vector<dem::Vec3> force(grains.size(), dem::Vec3::Zero());
  std::vector<Eigen::Matrix3d> stress(grains.size(), Eigen::Matrix3d::Zero());
  const auto add = [&](std::int64_t index, const dem::Vec3& point, const dem::Vec3& f) {
    const auto g = static_cast<std::size_t>(index);
    ++coordination[g];
    force[g] += f;
    stress[g] += f * (point - grains[g].position).transpose() / grains[g].volume;
  };
  for (const dem::Contact& c : snapshot.contacts) {
    add(c.i, c.point, c.force);
    if (c.j >= 0) add(c.j, c.point, -c.force);
  }
  Grid grid;
  for (const dem::Grain& g : grains) grid.add_cell(outline(g), vtk_polygon);
  grid.add_integer("id", [&](std::size_t k) { return grains[k].id; });
  grid.add_number("radius", [&](std::size_t k) { return grains[k].radius; });
  grid.add_number("mass", [&](std::size_t k) { return grains[k].mass; });
  grid.add_integer("fixed", [&](std::size_t k) { return grains[k].fixed; });
  grid.add_integer("coordination", [&](std::size_t k) { return coordination[k]; });
  grid.add_number("angle", [&](std::size_t k) { return grains[k].angle; });
  grid.add_vector("force", [&](std::size_t k) { return force[k]; });
  grid.add_vector("velocity", [&](std::size_t k) { return grains[k].velocity; });
  grid.add_number("pressure", [&](std::size_t k) { return -stress[k].trace() / snapshot.dim; });
  grid.add_data("stress", "Float64", 9, [&](std::size_t k) {
    std::string row;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) row += fmt::format("{:.9g} ", stress[k](a, b));
    return row;
  });
  if (reference) {
    grid.add_vector("displacement", [&](std::size_t k) -> dem::Vec3 {
      return grains[k].position - reference->grains[k].position;
    });
    grid.add_number("rotation",
                    [&](std::size_t k) { return grains[k].angle - reference->grains[k].angle; });
  }
  grid.write(file);
}

void write_contacts_vtu(const std::string& file, const dem::Snapshot& snapshot) {
  const std::vector<dem::Contact>& contacts = snapshot.contacts;
  Grid grid;
  for (const dem::Contact& c : contacts)
    grid.add_cell({grain(snapshot, c.i).position, branch_end(snapshot, c)}, vtk_line);
  grid.add_integer("i", [&](std::size_t k) { return grain(snapshot, contacts[k].i).id; });
  grid.add_integer("j", [&](std::size_t k) {
    return contacts[k].j < 0 ? -1 : grain(snapshot, contacts[k].j).id;
  });
  grid.add_vector("force", [&](std::size_t k) { return contacts[k].force; });
  grid.add_number("normal_force", [&](std::size_t k) { return contacts[k].normal_force; });
  grid.add_number("tangential_force", [&](std::size_t k) { return contacts[k].tangential_force; });
  grid.add_integer("sliding", [&](std::size_t k) { return contacts[k].sliding; });
  grid.add_integer("wall",
                   [&](std::size_t k) { return contacts[k].j < 0 ? -1 - contacts[k].j : -1; });
  grid.write(file);
}

void write_chains_vtu(const std::string& file, const dem::Snapshot& snapshot) {
  double largest = 0;
  for (const dem::Contact& c : snapshot.contacts) largest = std::max(largest, c.normal_force);
  Grid grid;
  std::vector<double> force;
  for (const dem::Contact& c : snapshot.contacts) {
    const dem::Grain& gi = grain(snapshot, c.i);
    const dem::Vec3 end = branch_end(snapshot, c), along = end - gi.position;
    if (!(along.norm() > 0) || !(c.normal_force > 0)) continue;
    double radius = gi.radius;
    if (c.j >= 0) radius = std::min(radius, grain(snapshot, c.j).radius);
    const dem::Vec3 side =
        dem::Vec3(-along.y(), along.x(), 0).normalized() * (radius / 2 * c.normal_force / largest);
    grid.add_cell({gi.position - side, end - side, end + side, gi.position + side}, vtk_quad);
    force.push_back(c.normal_force);
  }
  grid.add_number("normal_force", [&](std::size_t k) { return force[k]; });
  grid.add_number("relative_force", [&](std::size_t k) { return force[k] / largest; });
  grid.write(file);
}

}  // namespace grainfield::coupling
