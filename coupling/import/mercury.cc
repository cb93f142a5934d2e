// MercuryDPM: NAME.data of the particles and NAME.fstat of their contacts, one file of all times or
// one for each (NAME.data.0001).
//
// A .data file has for every time a line and a row for each particle:
//
//   in space:  N time xmin ymin zmin xmax ymax zmax
//              x y z vx vy vz radius alpha beta gamma omega_x omega_y omega_z info    (14 columns)
//   in plane:  N time xmin ymin xmax ymax
//              x y vx vy radius angle omega info                                      (8 columns)
//
// Particles are called by the number of their row, from 0. A .fstat file has for every time three
// lines "# ..." (the first: time and version) and a row for each contact, for one of two particles
// two, each of them first:
//
//   time i j  cx cy cz  overlap  tangential_overlap  fn ft  nx ny nz  tx ty tz          (16
//   columns)
//
// j below 0 is the wall -1-j. The force on i is fn n + ft t; of a wall both directions are turned.
// A copy across a periodic side has a number beyond those of the particles; it is never first.
// Sources: MercuryDPM's page "Visualising Your Results" (Documentation/Pages/Analysing.dox), and
// BaseInteraction::writeToFStat and DPMBase::writeFstatHeader of version 1 of the .fstat.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "coupling/import/foreign_kind.h"
#include "coupling/import/format.h"
#include "dem/shared/number.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {
namespace {

using Names = std::vector<std::string>;

std::shared_ptr<const Names> names_of(std::string_view text) {
  std::vector<std::string_view> words;
  split(text, ' ', words);
  return std::make_shared<const Names>(words.begin(), words.end());
}

class MercuryScan {
 public:
  explicit MercuryScan(const std::string& file) : lines_(file) { table_.file = file; }

  std::vector<ForeignTable> tables() {
    std::string_view line;
    while (lines_.next(line)) {
      line = trimmed(line);
      if (line.empty()) continue;
      if (line.front() == '#') {
        if (!contacts(std::string(line))) break;
      } else if (!particles(line)) {
        break;
      }
    }
    if (found_.empty())
      throw std::invalid_argument(lines_.file() + ": is empty, expected a .data or .fstat file");
    return std::move(found_);
  }

 private:
  [[noreturn]] void refuse(std::string_view line, const std::string& wanted) const {
    // The sign of a comment may be off already.
    std::string kind = foreign_kind(line, "mercury");
    if (kind.empty()) kind = foreign_kind(fmt::format("#{}", line), "mercury");
    throw std::invalid_argument(fmt::format("{}: found \"{}\", expected {}{}", lines_.where(),
                                            line.substr(0, 60), wanted,
                                            kind.empty() ? "" : "; this is " + kind));
  }

  static std::shared_ptr<const Names> columns_of_contacts() {
    static const auto columns = names_of("time i j px py pz overlap slip fn ft nx ny nz tx ty tz");
    return columns;
  }

  std::vector<double> numbers(std::string_view line, const std::string& wanted) const {
    std::vector<std::string_view> words;
    split(line, ' ', words);
    std::vector<double> out;
    for (const std::string_view word : words) {
      const auto number = parse_number(word);
      if (!number || !(std::abs(*number) <= dem::kMostNumber)) refuse(line, wanted);
      out.push_back(*number);
    }
    return out;
  }

  // Programs write columns of their own behind those of MercuryDPM.
  static std::shared_ptr<const Names> with_more(Names names, std::string_view row) {
    std::vector<std::string_view> words;
    split(trimmed(row), ' ', words);
    while (names.size() < words.size()) names.push_back(fmt::format("column {}", names.size() + 1));
    return std::make_shared<const Names>(std::move(names));
  }

  // False where the file ends within the rows.
  bool particles(std::string_view line) {
    static const auto space =
        names_of("x y z vx vy vz radius alpha beta gamma spin_x spin_y spin info");
    static const auto plane = names_of("x y vx vy radius angle spin info");
    const std::string wanted = "\"N time xmin ymin zmin xmax ymax zmax\" (in the plane without z)";
    const std::vector<double> head = numbers(line, wanted);
    if (head.size() == columns_of_contacts()->size())
      refuse(line,
             fmt::format("{}; a .fstat has three lines \"# ...\" before the contacts of a time",
                         wanted));
    if ((head.size() != 8 && head.size() != 6) || head[0] != std::floor(head[0]) || head[0] < 0)
      refuse(line, wanted);
    table_.kind = TableKind::grains;
    table_.columns = head.size() == 8 ? space : plane;
    table_.time = head[1];
    table_.header_line = lines_.line();
    table_.first = lines_.place();
    table_.rows = static_cast<long long>(head[0]);
    std::string_view row;
    long long n = 0;
    for (; n < table_.rows && lines_.next(row); ++n) {
      while (trimmed(row).empty() && lines_.next(row)) {
      }
      if (n == 0) table_.columns = with_more(*table_.columns, row);
    }
    const bool whole = n == table_.rows && !(lines_.unfinished() && n > 0);
    if (!whole)
      table_.broken = fmt::format(
          "{}: truncated: time {} has {} particles announced, {} there{}", lines_.where(), head[1],
          table_.rows, n, n == table_.rows ? ", the last one without the end of its line" : "");
    found_.push_back(table_);
    return whole;
  }

  // `head`: "# time version".
  bool contacts(const std::string& head) {
    const auto columns = columns_of_contacts();
    const std::vector<double> told = numbers(head.substr(1), "\"# time version\"");
    if (told.empty()) refuse(head, "\"# time version\"");
    std::string_view line;
    for (int k = 0; k < 2; ++k)
      if (!lines_.next(line) || !trimmed(line).starts_with('#'))
        refuse(line, "three lines \"# ...\" before the contacts of a time");
    table_.kind = TableKind::contacts;
    table_.columns = columns;
    table_.time = told[0];
    table_.header_line = lines_.line() - 2;
    table_.first = lines_.place();
    table_.rows = 0;
    bool whole = true;
    for (Lines::Place before = lines_.place(); lines_.next(line); before = lines_.place()) {
      if (trimmed(line).starts_with('#')) {
        lines_.seek(before);
        break;
      }
      if (trimmed(line).empty()) continue;
      ++table_.rows;
      whole = !lines_.unfinished();
    }
    if (!whole)
      table_.broken = lines_.where() + ": truncated: the file ends in the middle of a line";
    found_.push_back(table_);
    return whole;
  }

  Lines lines_;
  ForeignTable table_;
  std::vector<ForeignTable> found_;
};

std::vector<ForeignTable> scan(const std::string& file, ColumnNames&) {
  return MercuryScan(file).tables();
}

}  // namespace

ImportFormat mercury_format() {
  ImportFormat format;
  format.name = "mercury";
  format.summary = "MercuryDPM's .data of the particles and .fstat of their contacts";
  format.scan = scan;
  format.densities_of_spheres = true;
  format.rows_are_ids = true;
  format.steps_by_time = true;
  format.directions_turn_together = true;
  format.copies_have_numbers = true;
  for (const char* name :
       {"x", "y",  "z",  "vx", "vy", "vz", "radius", "spin", "spin_x", "spin_y", "angle", "i",
        "j", "px", "py", "pz", "fn", "ft", "nx",     "ny",   "nz",     "tx",     "ty",    "tz"})
    format.columns.emplace_back(name, name);
  return format;
}

}  // namespace grainfield::coupling
