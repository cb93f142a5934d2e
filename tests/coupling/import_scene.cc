#include "import_scene.h"

#include <fmt/format.h>

#include <numbers>

namespace grainfield::test {

dem::Snapshot overlapping_layer(unsigned seed, int columns, int rows, bool rough, double load) {
  dem::Snapshot s = layer(seed, columns, rows, rough, load);
  for (dem::Grain& g : s.grains) {
    g.radius *= 1.4;
    g.volume = std::numbers::pi * g.radius * g.radius;
  }
  for (dem::Contact& c : s.contacts) {
    if (c.j < 0) continue;
    const dem::Grain &a = s.grains[static_cast<std::size_t>(c.i)],
                     &b = s.grains[static_cast<std::size_t>(c.j)];
    const double d = (b.position - a.position).norm();
    c.point = a.position + (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d) * c.normal;
  }
  return s;
}

std::string wall_or_id(const dem::Snapshot& s, std::int64_t j) {
  if (j < 0) return s.walls[static_cast<std::size_t>(-1 - j)].name;
  return fmt::format("{}", s.grains[static_cast<std::size_t>(j)].id);
}

std::string outline_text(const dem::Outline& outline) {
  std::string text;
  for (const auto& [x, y] : outline) text += fmt::format("{}{} {}", text.empty() ? "" : ";", x, y);
  return text;
}

std::string csv_grains(const dem::Snapshot& s) {
  std::string out =
      "# grains, SI\nid,x,y,vx,vy,angle,spin,radius,mass,inertia,volume,fixed,outline\n";
  for (const dem::Grain& g : s.grains)
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", g.id, g.position.x(),
                       g.position.y(), g.velocity.x(), g.velocity.y(), g.angle, g.spin, g.radius,
                       g.mass, g.inertia, g.volume, g.fixed ? 1 : 0, outline_text(g.outline));
  return out;
}

std::string csv_contacts(const dem::Snapshot& s) {
  std::string out = "i,j,px,py,nx,ny,fx,fy,friction,spring,sliding\n";
  for (const dem::Contact& c : s.contacts)
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", wall_or_id(s, c.i), wall_or_id(s, c.j),
                       c.point.x(), c.point.y(), c.normal.x(), c.normal.y(), c.force.x(),
                       c.force.y(), c.friction, c.spring, c.sliding ? 1 : 0);
  return out;
}

std::string csv_walls(const dem::Snapshot& s) {
  std::string out = "name,x,y,nx,ny,friction\n";
  for (const dem::Wall& w : s.walls)
    out += fmt::format("{},{},{},{},{},{}\n", w.name, w.point.x(), w.point.y(), w.normal.x(),
                       w.normal.y(), w.friction);
  return out;
}

std::pair<dem::Vec3, dem::Vec3> parts(const dem::Contact& c) {
  const dem::Vec3 normal = c.force.dot(c.normal) * c.normal;
  return {normal, c.force - normal};
}

std::string dump_grains(const dem::Snapshot& s, long step, bool wall_columns) {
  std::string out = fmt::format(
      "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n-0.5 "
      "0.5\n"
      "ITEM: ATOMS id type x y z radius mass",
      step, s.grains.size());
  if (wall_columns)
    for (const dem::Wall& w : s.walls)
      for (int k = 1; k <= 7; ++k) out += fmt::format(" f_{}[{}]", w.name, k);
  out += " \n";
  for (std::size_t g = 0; g < s.grains.size(); ++g) {
    const dem::Grain& a = s.grains[g];
    out += fmt::format("{} {} {} {} {} {} {}", a.id, a.fixed ? 2 : 1, a.position.x(),
                       a.position.y(), a.position.z(), a.radius, a.mass);
    for (std::size_t w = 0; wall_columns && w < s.walls.size(); ++w) {
      const dem::Contact* found = nullptr;
      for (const dem::Contact& c : s.contacts)
        if (c.i == static_cast<std::int64_t>(g) && c.j == -1 - static_cast<std::int64_t>(w))
          found = &c;
      if (found)
        out += fmt::format(" 1 {} {} {} {} {} {}", found->force.x(), found->force.y(),
                           found->force.z(), found->point.x(), found->point.y(), found->point.z());
      else
        out += " 0 0 0 0 0 0 0";
    }
    out += " \n";
  }
  return out;
}

std::string dump_header(long step, long rows, const std::string& columns) {
  return fmt::format(
      "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ENTRIES\n{}\nITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n"
      "-0.5 0.5\nITEM: ENTRIES {}\n",
      step, rows, columns);
}

std::string lammps_contacts(const dem::Snapshot& s, long step) {
  std::string rows;
  long n = 0;
  for (const dem::Contact& c : s.contacts) {
    if (c.j < 0) continue;
    const auto [fn, ft] = parts(c);
    // Every other pair the other way round.
    const double sign = n % 2 == 0 ? 1 : -1;
    const std::int64_t a = n % 2 == 0 ? c.i : c.j, b = n % 2 == 0 ? c.j : c.i;
    rows += fmt::format("{} {} {} {} {} {} {} {} {} \n", ++n, wall_or_id(s, a), wall_or_id(s, b),
                        sign * fn.x(), sign * fn.y(), sign * fn.z(), sign * ft.x(), sign * ft.y(),
                        sign * ft.z());
  }
  return dump_header(step, n,
                     "index c_ids[1] c_ids[2] c_p[1] c_p[2] c_p[3] c_p[4] c_p[5] c_p[6] ") +
         rows;
}

std::string liggghts_contacts(const dem::Snapshot& s, long step) {
  std::string rows;
  long n = 0;
  for (const dem::Contact& c : s.contacts) {
    if (c.j < 0) continue;
    ++n;
    rows += fmt::format("{} {} 0 {} {} {} \n", wall_or_id(s, c.i), wall_or_id(s, c.j), c.force.x(),
                        c.force.y(), c.force.z());
  }
  return dump_header(step, n, "c_fc[1] c_fc[2] c_fc[3] c_fc[4] c_fc[5] c_fc[6] ") + rows;
}

std::string liggghts_walls(const dem::Snapshot& s, long step) {
  std::string rows;
  long n = 0;
  for (const dem::Contact& c : s.contacts) {
    if (c.j >= 0) continue;
    ++n;
    rows += fmt::format("{} {} {} 0 0 0 {} 5 {} {} {} {} \n", c.point.x(), c.point.y(), c.point.z(),
                        -1 - c.j, wall_or_id(s, c.i), c.force.x(), c.force.y(), c.force.z());
  }
  std::string names;
  for (int k = 1; k <= 12; ++k) names += fmt::format("c_fw[{}] ", k);
  return dump_header(step, n, names) + rows;
}

std::string yade_bodies(const dem::Snapshot& s) {
  std::string out = "#format id_x_y_z_r_mass_fixed\n# written by a test\n";
  for (const dem::Grain& g : s.grains)
    out += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}\n", g.id, g.position.x(), g.position.y(),
                       g.position.z(), g.radius, g.mass, g.fixed ? 1 : 0);
  return out;
}

std::string yade_interactions(const dem::Snapshot& s) {
  std::string out = "# id1 id2 px py pz nx ny nz fnx fny fnz ftx fty ftz\n";
  for (const dem::Contact& c : s.contacts) {
    const auto [fn, ft] = parts(c);
    out += fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {}\n", wall_or_id(s, c.i),
                       c.j < 0 ? fmt::format("{}", 9000 - 1 - c.j) : wall_or_id(s, c.j),
                       c.point.x(), c.point.y(), c.point.z(), c.normal.x(), c.normal.y(),
                       c.normal.z(), -fn.x(), -fn.y(), -fn.z(), -ft.x(), -ft.y(), -ft.z());
  }
  return out;
}

}  // namespace grainfield::test
