#include "coupling/store/vtu.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coupling/store/added_forces.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/vtu_grid.h"
#include "dem/snapshot/displacements.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

/// Cells that share no points. Their data are of the cells, or the same at every point of one:
/// glyphs and tubes take them from there.
class Grid {
 public:
  explicit Grid(const dem::Snapshot& of, bool on_points = false) : on_points_(on_points) {
    grid_.set_field_data(added_forces_in_vtk(of));
  }

  void add_cell(const std::vector<dem::Vec3>& corners, VtuCell type) {
    std::vector<std::size_t> points;
    for (const dem::Vec3& c : corners) points.push_back(grid_.add_point(c.x(), c.y(), c.z()));
    grid_.add_cell(type, points);
    corners_.push_back(corners.size());
  }

  /// `of` gives the text of cell k's value.
  template <class Of>
  void add_data(const std::string& name, const char* type, int components, Of&& of) {
    std::string rows;
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      const std::string text = of(k) + "\n";
      for (std::size_t times = on_points_ ? corners_[k] : 1; times > 0; --times) rows += text;
    }
    grid_.add_data(on_points_ ? VtuGrid::Place::points : VtuGrid::Place::cells, name, type,
                   components, rows);
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

  void write(const std::string& file) const { write_text_file(file, grid_.text()); }

 private:
  VtuGrid grid_;
  std::vector<std::size_t> corners_;  // of each cell
  bool on_points_;
};

const dem::Grain& grain(const dem::Snapshot& snapshot, std::int64_t index) {
  return snapshot.grains[static_cast<std::size_t>(index)];
}

// From the centre of i to the centre of j (of its image), or to the contact point on a wall.
dem::Vec3 branch_end(const dem::Snapshot& snapshot, const dem::Contact& contact) {
  return contact.j >= 0 ? dem::second_place(snapshot, contact) : contact.point;
}

// The shortest rotation from one orientation to another, rad along its axis.
dem::Vec3 turn_between(const dem::Grain& from, const dem::Grain& to) {
  const auto quaternion = [](const dem::Grain& g) {
    const auto& q = g.orientation;
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  };
  const Eigen::AngleAxisd turn(quaternion(to) * quaternion(from).conjugate());
  const double angle =
      turn.angle() > std::numbers::pi ? turn.angle() - 2 * std::numbers::pi : turn.angle();
  return angle * turn.axis();
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

std::vector<dem::Vec3> surface_strip(const dem::Grain& grain, int bands) {
  const auto& q = grain.orientation;
  const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
  const auto power = [](double x, double e) { return std::copysign(std::pow(std::fabs(x), e), x); };
  const auto at = [&](int band, int side) {
    const double up = std::numbers::pi * (static_cast<double>(band) / bands - 0.5);
    const double around = std::numbers::pi * side / bands;
    // At the poles the cosine is not quite 0.
    const double level = band == 0 || band == bands ? 0 : power(std::cos(up), grain.exponents[1]);
    const dem::Vec3 x(level * power(std::cos(around), grain.exponents[0]),
                      level * power(std::sin(around), grain.exponents[0]),
                      power(std::sin(up), grain.exponents[1]));
    return dem::Vec3(grain.position + turn * grain.axes.cwiseProduct(x));
  };
  std::vector<dem::Vec3> points;
  for (int band = 0; band < bands; ++band) {
    for (int side = 0; side <= 2 * bands; ++side) {
      points.push_back(at(band + 1, side));
      points.push_back(at(band, side));
    }
  }
  return points;
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
  const auto add = [&](std::int64_t index, const dem::Vec3& arm, const dem::Vec3& f) {
    const auto g = static_cast<std::size_t>(index);
    ++coordination[g];
    force[g] += f;
    stress[g] += f * arm.transpose() / grains[g].volume;
  };
  for (const dem::Contact& c : snapshot.contacts) {
    add(c.i, c.point - grain(snapshot, c.i).position, c.force);
    if (c.j >= 0) add(c.j, c.point - dem::second_place(snapshot, c), -c.force);
  }
  const bool spheres = snapshot.dim == 3;
  const bool surfaces =
      std::any_of(grains.begin(), grains.end(), [](const auto& g) { return !g.axes.isZero(0); });
  Grid grid(snapshot, spheres && !surfaces);
  for (const dem::Grain& g : grains) {
    if (surfaces)
      grid.add_cell(surface_strip(g), VtuCell::strip);
    else if (spheres)
      grid.add_cell({g.position}, VtuCell::vertex);
    else
      grid.add_cell(outline(g), VtuCell::polygon);
  }
  grid.add_integer("id", [&](std::size_t k) { return grains[k].id; });
  grid.add_number("radius", [&](std::size_t k) { return grains[k].radius; });
  grid.add_number("mass", [&](std::size_t k) { return grains[k].mass; });
  grid.add_integer("fixed", [&](std::size_t k) { return grains[k].fixed; });
  grid.add_integer("coordination", [&](std::size_t k) { return coordination[k]; });
  if (spheres) {
    grid.add_data("orientation", "Float64", 4, [&](std::size_t k) {
      const auto& q = grains[k].orientation;
      return fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}", q[0], q[1], q[2], q[3]);
    });
    grid.add_vector("angular_velocity", [&](std::size_t k) { return grains[k].angular_velocity; });
  } else {
    grid.add_number("angle", [&](std::size_t k) { return grains[k].angle; });
  }
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
    const dem::Displacements displacements(*reference, snapshot);
    grid.add_vector("displacement", [&](std::size_t k) { return displacements.of(k); });
    if (spheres)
      grid.add_vector("rotation",
                      [&](std::size_t k) { return turn_between(reference->grains[k], grains[k]); });
    else
      grid.add_number("rotation",
                      [&](std::size_t k) { return grains[k].angle - reference->grains[k].angle; });
  }
  grid.write(file);
}

void write_contacts_vtu(const std::string& file, const dem::Snapshot& snapshot) {
  const std::vector<dem::Contact>& contacts = snapshot.contacts;
  Grid grid(snapshot);
  for (const dem::Contact& c : contacts)
    grid.add_cell({grain(snapshot, c.i).position, branch_end(snapshot, c)}, VtuCell::line);
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

void write_chains_vtu(const std::string& file, const dem::Snapshot& snapshot,
                      const std::vector<int>& chain_of) {
  if (chain_of.size() != snapshot.contacts.size())
    throw std::invalid_argument(fmt::format("{}: {} contacts, chains given for {}", file,
                                            snapshot.contacts.size(), chain_of.size()));
  double largest = 0;
  for (const dem::Contact& c : snapshot.contacts) largest = std::max(largest, c.normal_force);
  const bool tubes = snapshot.dim == 3;
  Grid grid(snapshot, tubes);
  std::vector<double> force, width;
  std::vector<int> chain;
  for (std::size_t k = 0; k < chain_of.size(); ++k) {
    if (chain_of[k] < 0) continue;
    const dem::Contact& c = snapshot.contacts[k];
    const dem::Grain& gi = grain(snapshot, c.i);
    const dem::Vec3 end = branch_end(snapshot, c), along = end - gi.position;
    if (!(along.norm() > 0) || !(c.normal_force > 0)) continue;
    double radius = gi.radius;
    if (c.j >= 0) radius = std::min(radius, grain(snapshot, c.j).radius);
    chain.push_back(chain_of[k]);
    force.push_back(c.normal_force);
    width.push_back(radius / 2 * c.normal_force / largest);
    if (tubes) {
      grid.add_cell({gi.position, end}, VtuCell::line);
      continue;
    }
    const dem::Vec3 side = dem::Vec3(-along.y(), along.x(), 0).normalized() * width.back();
    grid.add_cell({gi.position - side, end - side, end + side, gi.position + side}, VtuCell::quad);
  }
  grid.add_integer("chain", [&](std::size_t k) { return chain[k]; });
  grid.add_number("normal_force", [&](std::size_t k) { return force[k]; });
  grid.add_number("relative_force", [&](std::size_t k) { return force[k] / largest; });
  if (tubes) grid.add_number("tube_radius", [&](std::size_t k) { return width[k]; });
  grid.write(file);
}

}  // namespace grainfield::coupling
