// YADE: text of yade.export.textExt or of a script (docs/import.md). Comment lines before the first
// row name the columns: "#format id_x_y_z_r_matId" or "# id x y z r mass", of those with as many
// names as the row has values the one with the most known ones. YADE's contact forces act on the
// second body.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "coupling/import/foreign_kind.h"
#include "coupling/import/format.h"
#include "coupling/import/synonyms.h"
#include "coupling/import/told_units.h"

namespace grainfield::coupling {
namespace {

std::vector<std::string> names_of(std::string_view comment) {
  std::vector<std::string_view> words;
  split(comment, ' ', words);
  if (words.size() == 2 && words[0] == "format") {
    const std::string_view format = words[1];
    split(format, '_', words);
  }
  if (words.size() == 1 && words[0].find(',') != std::string_view::npos) {
    const std::string_view names = words[0];
    split(names, ',', words);
  }
  return {words.begin(), words.end()};
}

struct Comment {
  std::vector<std::string> names;
  long long line = 0;
  std::string text;
};

// "#format x_y_z_r_attrs" and behind it "#id mass": attributes stand in place of their word.
void put_attributes(std::vector<Comment>& comments) {
  for (std::size_t k = 0; k + 1 < comments.size(); ++k) {
    std::vector<std::string>& names = comments[k].names;
    if (names.empty() || !names.back().starts_with("attr")) continue;
    names.pop_back();
    names.insert(names.end(), comments[k + 1].names.begin(), comments[k + 1].names.end());
  }
}

// The comment with the most known names among those with as many names as the row has values.
const Comment* best_of(const std::vector<Comment>& comments, std::size_t count) {
  const Comment* best = nullptr;
  std::ptrdiff_t most = -1;
  for (const Comment& comment : comments) {
    if (comment.names.size() != count) continue;
    const auto known = std::count_if(comment.names.begin(), comment.names.end(), is_known_name);
    if (known < most) continue;
    most = known;
    best = &comment;
  }
  return best;
}

// The forces of YADE act on the second body, which --from csv does not know.
constexpr const char* kCommas =
    "; a table with commas is read by --from csv (with --flip-forces where forces act on the "
    "second "
    "body)";

// Attributes that no comment names are called by their numbers, "attrs[1]", for --column.
void number_attributes(std::vector<Comment>& comments, std::size_t count) {
  for (Comment& comment : comments) {
    std::vector<std::string>& names = comment.names;
    if (names.empty() || !names.back().starts_with("attr") || names.size() > count) continue;
    const std::string word = names.back();
    names.pop_back();
    for (int k = 1; names.size() < count; ++k) names.push_back(fmt::format("{}[{}]", word, k));
  }
}

std::vector<ForeignTable> scan(const std::string& file, ColumnNames&) {
  Lines lines(file);
  std::vector<Comment> comments;
  std::vector<std::string_view> fields;
  ForeignTable table;
  table.file = file;
  table.any_names = true;
  table.first = lines.place();
  const auto named = [&](const Comment& comment) {
    std::vector<std::string> names = comment.names;
    for (const Comment& other : comments) {
      if (other.line == comment.line) continue;
      const auto units = units_row(other.text, ' ', names.size());
      if (units) {
        names = names_with_units(std::move(names), *units);
        table.unit_remark.clear();
        break;
      }
      if (table.unit_remark.empty()) table.unit_remark = unit_remark(file, other.line, other.text);
    }
    table.columns = std::make_shared<const std::vector<std::string>>(std::move(names));
    table.header_line = comment.line;
    return std::vector<ForeignTable>{table};
  };
  for (std::string_view line; lines.next(line); table.first = lines.place()) {
    line = trimmed(line);
    if (line.empty()) continue;
    if (line.front() == '#') {
      comments.push_back({names_of(line.substr(1)), lines.line(), std::string(line.substr(1))});
      continue;
    }
    put_attributes(comments);
    split(line, ' ', fields);
    number_attributes(comments, fields.size());
    if (const std::string kind = foreign_kind(
            comments.empty() ? std::string(line) : "#" + comments.front().text, "yade");
        !kind.empty())
      throw std::invalid_argument(fmt::format("{}: this is {}", file, kind));
    if (fields.size() == 1 && line.find(',') != std::string_view::npos)
      throw std::invalid_argument(
          fmt::format("{}: found \"{}\", expected values with blanks between{}", lines.where(),
                      line.substr(0, 60), kCommas));
    if (const Comment* best = best_of(comments, fields.size())) return named(*best);
    throw std::invalid_argument(fmt::format(
        "{}: no comment line above names the {} columns; expected \"#format id_x_y_z_r\" or "
        "\"# id x y z r mass\"{}",
        lines.where(), fields.size(),
        line.find(',') == std::string_view::npos
            ? "; where the first line has the names without #: put one before it"
            : kCommas));
  }
  // No rows: the last comment names the columns of an empty table.
  if (comments.empty()) throw std::invalid_argument(file + ": is empty");
  return named(comments.back());
}

}  // namespace

ImportFormat yade_format() {
  ImportFormat format;
  format.name = "yade";
  format.summary = "text of the bodies and of the interactions (docs/import.md has the script)";
  format.scan = scan;
  format.densities_of_spheres = true;
  format.force_sign = -1;
  const char* same[] = {
      "id",     "x",    "y",       "z",        "vx",     "vy",    "vz",      "angle",  "spin",
      "radius", "mass", "density", "inertia",  "volume", "fixed", "px",      "py",     "pz",
      "nx",     "ny",   "nz",      "fx",       "fy",     "fz",    "fnx",     "fny",    "fnz",
      "ftx",    "fty",  "ftz",     "friction", "sx",     "sy",    "sz",      "spin_x", "spin_y",
      "qw",     "qx",   "qy",      "qz",       "xu",     "yu",    "zu",      "ix",     "iy",
      "iz",     "fn",   "ft",      "tx",       "ty",     "tz",    "material"};
  for (const char* name : same) format.columns.emplace_back(name, name);
  format.columns.insert(format.columns.end(), {{"radius", "r"}, {"i", "id1"}, {"j", "id2"}});
  return format;
}

}  // namespace grainfield::coupling
