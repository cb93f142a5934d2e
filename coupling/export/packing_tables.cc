#include "coupling/export/packing_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "coupling/output/added_forces.h"

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

std::string grains_table(const dem::Snapshot& s) {
  const bool space = s.dim == 3;
  std::string out =
      space ? "id,x,y,z,vx,vy,vz,spin_x,spin_y,spin,qw,qx,qy,qz,radius,mass,inertia,"
              "volume,fixed,material\n"
            : "id,x,y,vx,vy,angle,spin,radius,mass,inertia,volume,fixed,material,outline\n";
  for (const dem::Grain& g : s.grains) {
    const dem::Vec3 &p = g.position, &v = g.velocity, &w = g.angular_velocity;
    const auto to = std::back_inserter(out);
    const int fixed = g.fixed ? 1 : 0;
    if (space) {
      fmt::format_to(to, "{},{},{},{},{},{},{},{},{},{},", g.id, p.x(), p.y(), p.z(), v.x(), v.y(),
                     v.z(), w.x(), w.y(), w.z());
      fmt::format_to(to, "{},{},{},{},{},{},{},{},{},{}\n", g.orientation[0], g.orientation[1],
                     g.orientation[2], g.orientation[3], g.radius, g.mass, g.inertia, g.volume,
                     fixed, g.material);
    } else {
      fmt::format_to(to, "{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", g.id, p.x(), p.y(), v.x(),
                     v.y(), g.angle, g.spin, g.radius, g.mass, g.inertia, g.volume, fixed,
                     g.material, corners_text(g.outline));
    }
  }
  return out;
}

std::string contacts_table(const dem::Snapshot& s) {
  const bool space = s.dim == 3;
  const bool springs =
      space && std::none_of(s.contacts.begin(), s.contacts.end(),
                            [](const auto& c) { return c.spring_vector.hasNaN(); });
  std::string out = !space    ? "i,j,px,py,nx,ny,fx,fy,friction,spring,sliding\n"
                    : springs ? "i,j,px,py,pz,nx,ny,nz,fx,fy,fz,friction,sx,sy,sz,sliding\n"
                              : "i,j,px,py,pz,nx,ny,nz,fx,fy,fz,friction,sliding\n";
  for (const dem::Contact& c : s.contacts) {
    const auto to = std::back_inserter(out);
    const std::string other = c.j >= 0
                                  ? fmt::format("{}", s.grains[static_cast<std::size_t>(c.j)].id)
                                  : s.walls[static_cast<std::size_t>(-1 - c.j)].name;
    fmt::format_to(to, "{},{}", s.grains[static_cast<std::size_t>(c.i)].id, other);
    for (const dem::Vec3& v : {c.point, c.normal, c.force}) {
      fmt::format_to(to, ",{},{}", v.x(), v.y());
      if (space) fmt::format_to(to, ",{}", v.z());
    }
    fmt::format_to(to, ",{}", known(c.friction));
    const dem::Vec3& spring = c.spring_vector;
    if (springs) fmt::format_to(to, ",{},{},{}", spring.x(), spring.y(), spring.z());
    if (!space) fmt::format_to(to, ",{}", known(c.spring));
    fmt::format_to(to, ",{}\n", c.sliding ? 1 : 0);
  }
  return out;
}

std::string walls_table(const dem::Snapshot& s) {
  if (s.walls.empty()) return "";
  const bool space = s.dim == 3;
  std::string out =
      space ? "name,x,y,z,nx,ny,nz,friction,material\n" : "name,x,y,nx,ny,friction,material\n";
  for (const dem::Wall& w : s.walls) {
    out += w.name;
    for (const dem::Vec3& v : {w.point, w.normal}) {
      out += fmt::format(",{},{}", v.x(), v.y());
      if (space) out += fmt::format(",{}", v.z());
    }
    out += fmt::format(",{},{}\n", known(w.friction), w.material);
  }
  return out;
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
