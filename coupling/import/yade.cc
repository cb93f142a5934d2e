// YADE: text of yade.export.textExt or of a script (docs/import.md). Comment lines before the first
// row name the columns: "#format id_x_y_z_r_matId" or "# id x y z r mass", whichever has as many
// names as the row has values. YADE's contact forces act on the second body.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "coupling/import/format.h"

namespace grainfield::coupling {
namespace {

std::vector<std::string> names_of(std::string_view comment) {
  std::vector<std::string_view> words;
  split(comment, ' ', words);
  if (words.size() == 2 && words[0] == "format") {
    const std::string_view format = words[1];
    split(format, '_', words);
  }
  return {words.begin(), words.end()};
}

std::vector<ForeignTable> scan(const std::string& file) {
  Lines lines(file);
  std::vector<std::vector<std::string>> names;
  std::vector<long long> at;
  std::vector<std::string_view> fields;
  ForeignTable table;
  table.file = file;
  table.first = lines.place();
  for (std::string_view line; lines.next(line); table.first = lines.place()) {
    line = trimmed(line);
    if (line.empty()) continue;
    if (line.front() == '#') {
      names.push_back(names_of(line.substr(1)));
      at.push_back(lines.line());
      continue;
    }
    split(line, ' ', fields);
    for (std::size_t k = names.size(); k-- > 0;) {
      if (names[k].size() != fields.size()) continue;
      table.columns = std::make_shared<const std::vector<std::string>>(names[k]);
      table.header_line = at[k];
      return {table};
    }
    throw std::invalid_argument(fmt::format(
        "{}: no comment line above names the {} columns; expected \"#format id_x_y_z_r\" or "
        "\"# id x y z r mass\"",
        lines.where(), fields.size()));
  }
  // No rows: the last comment names the columns of an empty table.
  if (names.empty()) throw std::invalid_argument(file + ": is empty");
  table.columns = std::make_shared<const std::vector<std::string>>(names.back());
  table.header_line = at.back();
  return {table};
}

}  // namespace

ImportFormat yade_format() {
  ImportFormat format;
  format.name = "yade";
  format.summary = "text of the bodies and of the interactions (docs/import.md has the script)";
  format.scan = scan;
  format.force_sign = -1;
  const char* same[] = {"id",     "x",    "y",        "z",    "vx",      "vy",      "vz",
                        "angle",  "spin", "radius",   "mass", "density", "inertia", "volume",
                        "fixed",  "px",   "py",       "pz",   "nx",      "ny",      "nz",
                        "fx",     "fy",   "fz",       "fnx",  "fny",     "fnz",     "ftx",
                        "fty",    "ftz",  "friction", "sx",   "sy",      "sz",      "spin_x",
                        "spin_y", "qw",   "qx",       "qy",   "qz"};
  for (const char* name : same) format.columns.emplace_back(name, name);
  format.columns.insert(format.columns.end(), {{"radius", "r"}, {"i", "id1"}, {"j", "id2"}});
  return format;
}

}  // namespace grainfield::coupling
