// CSV, with the habits of spreadsheets and of numpy.
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

class Tables : public MatrixRows {
 public:
  using MatrixRows::MatrixRows;
  Written write() {
    tables();
    return std::move(out_);
  }

 private:
  void tables() {
    out_.options.format = "csv";
    add("grains.csv", text_of(grains(), ""));
    add("contacts.csv", text_of(contacts(h_ != Habit::other_names || has_polygons(s_)), ""));
    if (s_.walls.empty()) return;
    Table t;
    put(t, {"name"});
    put(t, axes(""));
    put(t, axes("n"));
    for (const dem::Wall& wall : s_.walls) {
      std::vector<std::string> row{wall.name};
      put(row, wall.point, length_);
      put(row, wall.normal, 1);
      t.rows.push_back(row);
    }
    if (h_ == Habit::other_names) {
      // The places of a wall have no names of other programs.
    }
    add("walls.csv", text_of(t, ""));
  }

  std::string text_of(Table t, const std::string& first) const {
    shuffle(t);
    if (h_ == Habit::other_names)
      for (const auto& [from, to] :
           std::vector<std::pair<std::string, std::string>>{{"id", "Particle ID"},
                                                            {"x", "Pos-X"},
                                                            {"y", "pos_y"},
                                                            {"z", "PosZ"},
                                                            {"radius", "Rad"},
                                                            {"mass", "Mass"},
                                                            {"i", "end1"},
                                                            {"j", "end2"},
                                                            {"fx", "force_x"},
                                                            {"fy", "force_y"},
                                                            {"fz", "force_z"}})
        if (d_ != Dialect::numpy || to.find(' ') == std::string::npos) t.rename(from, to);
    const char separator = d_ == Dialect::semicolons ? ';'
                           : d_ == Dialect::tabs     ? '\t'
                           : d_ == Dialect::csv      ? ','
                                                     : ' ';
    const auto joined = [&](const std::vector<std::string>& row) {
      std::string line;
      for (std::size_t k = 0; k < row.size(); ++k) {
        if (k > 0) line += separator;
        line += h_ == Habit::quoted && row[k].find('"') == std::string::npos ? "\"" + row[k] + "\""
                                                                             : row[k];
      }
      return line;
    };
    std::string out = first;
    if (h_ == Habit::titled) out += fmt::format("sep={}\nParticle data at t = 2 s\n\n", separator);
    if (h_ == Habit::comments) out += "# made by a test, 2 s\n#\n";
    if (h_ == Habit::units && d_ == Dialect::csv)
      for (std::string& name : t.names) name += unit_of(name);
    if (h_ == Habit::quoted) {
      t.names.push_back("note");
      for (auto& row : t.rows)
        row.push_back("\"sand, \"\"fine\"\"" + std::string(1, separator) + "\"");
    }
    const std::string end = h_ == Habit::trailing ? std::string(2, separator) : "";
    out += (d_ == Dialect::numpy ? "# " : "") + joined(t.names) + end + "\n";
    if (h_ == Habit::unit_row) {
      std::vector<std::string> units;
      for (const std::string& name : t.names) {
        const std::string unit = unit_of(name);
        units.push_back(unit.empty() ? "-" : name == "outline" ? "m" : in_si(unit));
      }
      out += joined(units) + "\n";
    }
    for (std::size_t k = 0; k < t.rows.size(); ++k) {
      out += joined(t.rows[k]) + (k % 2 == 0 ? end : "") + "\n";
      if (h_ == Habit::blank_lines && k % 5 == 0) out += "\n";
      if (h_ == Habit::comments && k % 7 == 0) out += "# half\n";
    }
    if (h_ == Habit::blank_lines) out += "\n\n";
    return out;
  }
  static std::string unit_of(const std::string& name) {
    if (name == "x" || name == "y" || name == "z" || name == "radius" || name.front() == 'p' ||
        name == "xu" || name == "yu" || name == "zu")
      return " (mm)";
    return name == "mass" ? " (kg)" : name == "fx" || name == "fy" || name == "fz" ? " [N]" : "";
  }
  static std::string in_si(const std::string& unit) {
    return unit == " (mm)" ? "m" : unit == " (kg)" ? "kg" : "N";
  }
};

}  // namespace

Written write_tables(Dialect d, Habit h, const Motion& m, bool after) {
  return Tables(d, h, m, after).write();
}

}  // namespace grainfield::test
