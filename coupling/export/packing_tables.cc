#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "coupling/export/forms.h"
#include "coupling/result/csv.h"
#include "coupling/store/added_forces.h"

namespace grainfield::coupling {
namespace {

void require_columns(const dem::Snapshot& s) {
  for (const dem::Grain& g : s.grains) {
    if (!g.axes.isZero()) {
      throw std::invalid_argument(fmt::format(
          "--to csv: grain {} is a superellipsoid, which the tables cannot hold (--to vtu can)",
          g.id));
    }
  }
  for (const dem::Wall& w : s.walls) {
    if (w.shape == "plane") continue;
    throw std::invalid_argument(fmt::format(
        "--to csv: wall \"{}\" is a {}, the tables hold planes (--to vtu has the grains)", w.name,
        w.shape));
  }
  if (s.cell.is_periodic()) {
    throw std::invalid_argument(
        "--to csv: the packing is periodic, which the tables cannot hold (--to vtu can)");
  }
}

std::string corners_text(const dem::Outline& outline) {
  std::string out;
  for (const auto& [x, y] : outline) out += fmt::format("{}{} {}", out.empty() ? "" : ";", x, y);
  return out;
}

// An empty cell says that it is not known.
std::string known(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

// Components of a vector in the plane or in space.
std::vector<double> parts(const dem::Vec3& v, int dim) { return {v.data(), v.data() + dim}; }

std::string grains_table(const dem::Snapshot& s) {
  Csv out(Csv::kAllDigits);
  if (s.dim == 3) {
    out.row("id", "x", "y", "z", "vx", "vy", "vz", "spin_x", "spin_y", "spin", "qw", "qx", "qy",
            "qz", "radius", "mass", "inertia", "volume", "fixed", "material");
    for (const dem::Grain& g : s.grains) {
      out.row(g.id, g.position, g.velocity, g.angular_velocity, g.orientation, g.radius, g.mass,
              g.inertia, g.volume, g.fixed, g.material);
    }
  } else {
    out.row("id", "x", "y", "vx", "vy", "angle", "spin", "radius", "mass", "inertia", "volume",
            "fixed", "material", "outline");
    for (const dem::Grain& g : s.grains) {
      out.row(g.id, parts(g.position, 2), parts(g.velocity, 2), g.angle, g.spin, g.radius, g.mass,
              g.inertia, g.volume, g.fixed, g.material, corners_text(g.outline));
    }
  }
  return out.text();
}

std::string contacts_table(const dem::Snapshot& s) {
  const bool space = s.dim == 3;
  const bool springs =
      space && std::none_of(s.contacts.begin(), s.contacts.end(),
                            [](const auto& c) { return c.spring_vector.hasNaN(); });
  Csv out(Csv::kAllDigits);
  if (!space) {
    out.row("i", "j", "px", "py", "nx", "ny", "fx", "fy", "friction", "spring", "sliding");
  } else {
    out.add("i").add("j");
    for (const char* vector : {"p", "n", "f"}) {
      for (const char axis : {'x', 'y', 'z'}) out.add(std::string(vector) + axis);
    }
    out.add("friction");
    if (springs) out.add("sx").add("sy").add("sz");
    out.row("sliding");
  }
  for (const dem::Contact& c : s.contacts) {
    out.add(s.grains[static_cast<std::size_t>(c.i)].id);
    if (c.j >= 0)
      out.add(s.grains[static_cast<std::size_t>(c.j)].id);
    else
      out.add(s.walls[static_cast<std::size_t>(-1 - c.j)].name);
    for (const dem::Vec3& v : {c.point, c.normal, c.force}) out.add(parts(v, s.dim));
    out.add(known(c.friction));
    if (springs) out.add(c.spring_vector);
    if (!space) out.add(known(c.spring));
    out.row(c.sliding);
  }
  return out.text();
}

std::string walls_table(const dem::Snapshot& s) {
  if (s.walls.empty()) return "";
  Csv out(Csv::kAllDigits);
  if (s.dim == 3)
    out.row("name", "x", "y", "z", "nx", "ny", "nz", "friction", "material");
  else
    out.row("name", "x", "y", "nx", "ny", "friction", "material");
  for (const dem::Wall& w : s.walls) {
    out.row(w.name, parts(w.point, s.dim), parts(w.normal, s.dim), known(w.friction), w.material);
  }
  return out.text();
}

}  // namespace

PackingTables packing_tables(const dem::Snapshot& packing) {
  require_columns(packing);
  const std::string mark = added_forces_comment(packing);
  PackingTables out{mark + grains_table(packing), mark + contacts_table(packing),
                    walls_table(packing)};
  if (!out.walls.empty()) out.walls.insert(0, mark);
  return out;
}

}  // namespace grainfield::coupling
