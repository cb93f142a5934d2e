// Dumps of LAMMPS and LIGGGHTS.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "import_matrix_rows.h"
#include "import_scene.h"

namespace grainfield::test {
namespace {

using dem::Contact;
using dem::Grain;
using dem::Vec3;

class Dumps : public MatrixRows {
 public:
  using MatrixRows::MatrixRows;
  Written write() {
    dumps();
    return std::move(out_);
  }

 private:
  std::string dump(Table t, const std::string& kind, const std::string& item) const {
    shuffle(t);
    const dem::Cell<3> cell = box();
    const double xy = cell.edges(0, 1), xz = cell.edges(0, 2), yz = cell.edges(1, 2);
    const bool tilted = !cell.edges.isDiagonal(0);
    std::string bounds = "ITEM: BOX BOUNDS";
    if (tilted) bounds += " xy xz yz";
    for (std::size_t a = 0; a < 3; ++a)
      bounds += s_.cell.periodic[a] ? " pp" : a == 2 && !space_ ? " pp" : " ff";
    bounds += "\n";
    const double low[] = {std::min({0.0, xy, xz, xy + xz}), std::min(0.0, yz), 0};
    const double high[] = {std::max({0.0, xy, xz, xy + xz}), std::max(0.0, yz), 0};
    const double tilt[] = {xy, xz, yz};
    for (int a = 0; a < 3; ++a) {
      bounds += fmt::format("{:.17g} {:.17g}", length_ * (cell.low[a] + low[a]),
                            length_ * (cell.low[a] + cell.edges(a, a) + high[a]));
      bounds += tilted ? fmt::format(" {:.17g}\n", length_ * tilt[a]) : "\n";
    }
    std::string out;
    if (h_ == Habit::units) out += "ITEM: UNITS\ncgs\n";
    const std::string step = "ITEM: TIMESTEP\n2000\n", time = "ITEM: TIME\n0.5\n";
    // LAMMPS writes the time first.
    out += h_ == Habit::plain ? step : h_ == Habit::shuffled ? step + time : time + step;
    out += fmt::format("ITEM: NUMBER OF {}\n{}\n", kind, t.rows.size()) + bounds;
    out += fmt::format("ITEM: {} {} \n", item, fmt::join(t.names, " "));
    for (std::size_t k = 0; k < t.rows.size(); ++k) {
      out += fmt::format("{} \n", fmt::join(t.rows[k], " "));
      if (h_ == Habit::blank_lines && k % 9 == 0) out += "\n";
    }
    if (h_ == Habit::blank_lines) out += "\n";
    return h_ == Habit::step_twice ? out + out : out;
  }

  void dumps() {
    const bool lammps = d_ == Dialect::lammps;
    out_.options.format = name_of(d_);
    Table g = grains(), c, w;
    if (lammps) {
      for (std::size_t k = 0; k < s_.walls.size(); ++k)
        for (int n = 1; n <= 7; ++n)
          g.names.push_back(fmt::format("f_{}[{}]", s_.walls[k].name, n));
      for (std::size_t k = 0; k < s_.grains.size(); ++k)
        for (std::size_t wall = 0; wall < s_.walls.size(); ++wall)
          add_wall_columns(k, wall, g.rows[k]);
      for (int n = 1; n <= 2; ++n) c.names.push_back(fmt::format("c_ids[{}]", n));
      for (int n = 1; n <= 6; ++n) c.names.push_back(fmt::format("c_p[{}]", n));
      out_.options.columns = {"i,j=c_ids[1..2]", "fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]"};
      options_of_walls(0, 1, "f_");
    } else {
      for (int n = 1; n <= 6; ++n) c.names.push_back(fmt::format("c_fc[{}]", n));
      for (int n = 1; n <= 12; ++n) w.names.push_back(fmt::format("c_fw[{}]", n));
      out_.options.columns = {"i,j=c_fc[1..2]", "fx,fy,fz=c_fc[4..6]"};
      if (!s_.walls.empty())
        for (const char* more :
             {"px,py,pz=c_fw[1..3]", "wall=c_fw[7]", "i=c_fw[9]", "fx,fy,fz=c_fw[10..12]"})
          out_.options.columns.emplace_back(more);
      options_of_walls(0, 1);
    }
    for (const Pair& p : pairs(both())) {
      std::vector<std::string> row;
      if (p.j < 0) {
        put(row, p.point, length_);
        for (const char* none : {"0", "0", "0"}) row.emplace_back(none);
        row.push_back(fmt::format("{}", -1 - p.j));
        row.emplace_back("5");
        row.push_back(told_id(p.i));
        put(row, p.force, force_);
        w.rows.push_back(row);
        continue;
      }
      row = {told_id(p.i), told_id(p.j)};
      if (lammps) {
        const Vec3 normal = p.force.dot(p.normal) * p.normal;
        put(row, normal, force_);
        put(row, p.force - normal, force_);
      } else {
        row.emplace_back("0");
        put(row, p.force, force_);
      }
      c.rows.push_back(row);
    }
    add("grains.dump", dump(g, "ATOMS", "ATOMS"));
    add("contacts.dump", dump(c, "ENTRIES", "ENTRIES"));
    if (!lammps && !s_.walls.empty()) add("walls.dump", dump(w, "ENTRIES", "ENTRIES"));
  }
  void add_wall_columns(std::size_t grain, std::size_t wall, std::vector<std::string>& row) const {
    for (const Contact& c : s_.contacts) {
      if (c.i != static_cast<std::int64_t>(grain) || c.j != -1 - static_cast<std::int64_t>(wall))
        continue;
      row.emplace_back("1");
      put(row, (h_ == Habit::flipped ? -1 : 1) * c.force, force_);
      put(row, c.point, length_);
      return;
    }
    for (int n = 0; n < 7; ++n) row.emplace_back("0");
  }
};

}  // namespace

Written write_dumps(Dialect d, Habit h, const Motion& m, bool after) {
  return Dumps(d, h, m, after).write();
}

}  // namespace grainfield::test
