// Dump files of LAMMPS and LIGGGHTS: for every step "ITEM: ..." headers, then a known number of
// rows.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "coupling/import/foreign_kind.h"
#include "coupling/import/format.h"
#include "dem/shared/number.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {
namespace {

// "pp", or what each end of an axis is: fixed, shrink-wrapped (with a minimum).
bool is_boundary(std::string_view word) {
  return word == "pp" ||
         (word.size() == 2 && word.find_first_not_of("fsm") == std::string_view::npos);
}

class DumpScan {
 public:
  explicit DumpScan(const std::string& file) : lines_(file) {
    table_.file = file;
    table_.any_names = true;
    table_.prefixes = true;
    table_.columns = std::make_shared<const std::vector<std::string>>();
  }

  std::vector<ForeignTable> tables() {
    std::string_view line;
    while (lines_.next(line)) {
      if (trimmed(line).empty()) continue;
      if (lines_.unfinished()) {
        truncated_ = lines_.where() + ": truncated: the file ends in the middle of a line";
        break;
      }
      line = trimmed(line);
      if (!line.starts_with("ITEM:")) {
        const std::string first(line);
        if (found_.empty() && !open_ && pass_title()) continue;
        refuse_line(first);
      }
      if (!item(std::string(trimmed(line.substr(5))))) break;
    }
    if (open_ && truncated_.empty())
      truncated_ =
          fmt::format("{}: truncated: the file ends before the rows of {}", lines_.where(),
                      table_.step ? fmt::format("step {}", *table_.step) : std::string("a step"));
    if (found_.empty() && truncated_.empty())
      throw std::invalid_argument(table_.file + ": is empty, expected a dump file");
    if (!truncated_.empty()) {
      table_.broken = truncated_;
      found_.push_back(table_);
    }
    return std::move(found_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument(fmt::format("{}: {}", lines_.where(), what));
  }

  // Goes on to the first "ITEM: TIMESTEP", UNITS or TIME where only some lines of a title stand
  // before it.
  bool pass_title() {
    constexpr int kTitle = 20;  // lines, at most
    const Lines::Place back = lines_.place();
    Lines::Place before = back;
    std::string_view line;
    for (int n = 0; n < kTitle && lines_.next(line); ++n) {
      const std::string_view text = trimmed(line);
      for (const char* begins : {"ITEM: TIMESTEP", "ITEM: UNITS", "ITEM: TIME"})
        if (text.starts_with(begins)) {
          lines_.seek(before);
          return true;
        }
      if (text.starts_with("ITEM:")) break;
      before = lines_.place();
    }
    lines_.seek(back);
    return false;
  }

  // A line between the steps that begins none.
  [[noreturn]] void refuse_line(std::string_view line) const {
    const std::string kind = foreign_kind(line, "dump");
    refuse(fmt::format("found \"{}\", expected \"ITEM: ...\"; {}", line.substr(0, 60),
                       kind.empty() ? "is this a dump file? --from csv reads tables with a line of "
                                      "names, and extended XYZ"
                                    : "this is " + kind));
  }

  // False at the end of the file, which is then truncated.
  bool next(std::string_view& line, const char* what) {
    if (lines_.next(line) && !lines_.unfinished()) return true;
    truncated_ = fmt::format("{}: truncated: the file ends before {}", lines_.where(), what);
    return false;
  }

  static constexpr const char* kStep = "the number of the time step";
  bool whole(long long& value, const char* what) {
    std::string_view line;
    if (!next(line, what)) return false;
    line = trimmed(line);
    std::optional<long long> number = parse_integer(line);
    if (!number) {  // "2000.0"
      const std::optional<double> real = parse_number(line);
      if (real && *real == std::floor(*real) && std::abs(*real) < 9e15)
        number = static_cast<long long>(*real);
    }
    if (!number || *number < 0)
      refuse(fmt::format("found \"{}\", expected {}, a whole number{}", line.substr(0, 60), what,
                         parse_number(line) && what == kStep
                             ? "; a time in s stands behind a line \"ITEM: TIME\""
                             : ""));
    value = *number;
    return true;
  }

  bool item(const std::string& name) {
    std::string_view line;
    if (name == "TIMESTEP") {
      long long step = 0;
      table_.box.reset();
      rows_ = -1;
      table_.columns = std::make_shared<const std::vector<std::string>>();
      if (!whole(step, kStep)) return false;
      table_.step = step;
      open_ = true;
      return true;
    }
    if (name == "TIME") {
      if (!next(line, "the time")) return false;
      line = trimmed(line);
      const std::optional<double> time = parse_number(line);
      if (!time || !(*time >= 0 && *time <= dem::kMostNumber))
        refuse(fmt::format("found \"{}\", expected the time, a finite number from 0",
                           line.substr(0, 60)));
      time_ = *time;
      open_ = true;
      return true;
    }
    if (name == "UNITS") {
      if (!next(line, "the units")) return false;
      const std::string told(trimmed(line));
      const std::optional<UnitSystem> units = parse_unit_system(told);
      if (!units || units->lengths_only) {
        table_.unknown_units = fmt::format("{}: units \"{}\"", lines_.where(), told);
        return true;
      }
      table_.units = *units;
      table_.told_units = lines_.where();
      return true;
    }
    if (name.starts_with("LABEL")) return next(line, "the label");
    if (name.starts_with("NUMBER OF ")) return whole(rows_, "the number of rows");
    if (name.starts_with("BOX BOUNDS")) return bounds(name);
    return rows(name);
  }

  // "BOX BOUNDS pp pp ff" and three lines "low high"; tilted ones "BOX BOUNDS xy xz yz pp pp ff"
  // with the tilt as a third number, or "BOX BOUNDS abc origin pp pp ff" with an edge and a
  // coordinate of the corner in each line.
  bool bounds(const std::string& name) {
    std::vector<std::string_view> words, fields;
    split(name, ' ', words);
    words.erase(words.begin(), words.begin() + 2);
    // Old tilted ones have no words of the boundaries.
    const bool old = words.size() == 3 && words[0] == "xy";
    const bool tilted = words.size() == 6 || old, general = words.size() == 5;
    if (old) words.clear();
    if (words.size() > 3) words.erase(words.begin(), words.end() - 3);
    // Very old dumps have none.
    bool known = words.empty() || words.size() == 3;
    for (const std::string_view word : words) known = known && is_boundary(word);
    if (!known)
      refuse(fmt::format("found the boundaries \"{}\", expected three of pp or two of f, s, m each",
                         name.substr(0, 60)));
    dem::Cell<3> cell;
    for (std::size_t a = 0; a < words.size(); ++a) cell.periodic[a] = words[a] == "pp";
    const std::size_t wanted = general ? 4 : tilted ? 3 : 2;
    std::array<std::array<double, 4>, 3> rows{};
    for (auto& row : rows) {
      std::string_view line;
      if (!next(line, "the box bounds")) return false;
      if (line.starts_with("ITEM:"))
        refuse(fmt::format("found \"{}\", expected three lines of box bounds", line.substr(0, 60)));
      split(line, ' ', fields);
      // Other writers call them: "0 1 xlo xhi".
      const bool named = fields.size() == wanted + 2 && fields.back().ends_with("hi");
      bool good = fields.size() == wanted || named;
      for (std::size_t k = 0; good && k < wanted; ++k) {
        const auto number = parse_number(fields[k]);
        good = number && std::isfinite(*number);
        if (good) row[k] = *number;
      }
      if (!good && cell.is_periodic())
        refuse(fmt::format("found \"{}\", expected {} finite numbers of the box bounds",
                           line.substr(0, 60), wanted));
      known = known && good;
    }
    if (cell.is_periodic() || known) set_box(rows, tilted, general, cell);
    if (!known && !cell.is_periodic()) return true;
    const bool same = box_ && box_->periodic == cell.periodic && box_->low == cell.low &&
                      box_->edges == cell.edges;
    if (!same) box_ = std::make_shared<const dem::Cell<3>>(cell);
    table_.box = box_;
    return true;
  }

  void set_box(const std::array<std::array<double, 4>, 3>& rows, bool tilted, bool general,
               dem::Cell<3>& cell) const {
    if (general) {
      for (int a = 0; a < 3; ++a) {
        const auto& row = rows[static_cast<std::size_t>(a)];
        cell.edges.col(a) = Eigen::Vector3d(row[0], row[1], row[2]);
        cell.low[a] = row[3];
      }
      return;
    }
    // Tilted boxes are given by the rectangular box around them.
    const double xy = tilted ? rows[0][2] : 0, xz = tilted ? rows[1][2] : 0,
                 yz = tilted ? rows[2][2] : 0;
    cell.low = {rows[0][0] - std::min({0.0, xy, xz, xy + xz}), rows[1][0] - std::min(0.0, yz),
                rows[2][0]};
    const Eigen::Vector3d high(rows[0][1] - std::max({0.0, xy, xz, xy + xz}),
                               rows[1][1] - std::max(0.0, yz), rows[2][1]);
    for (int a = 0; a < 3; ++a) {
      if (cell.is_periodic() && !(high[a] > cell.low[a]))
        refuse(fmt::format("found a box from {} to {} m along {}, expected low below high",
                           cell.low[a], high[a], "xyz"[a]));
      cell.edges(a, a) = high[a] - cell.low[a];
    }
    cell.edges(0, 1) = xy;
    cell.edges(0, 2) = xz;
    cell.edges(1, 2) = yz;
  }

  // "ATOMS id x y ..." and its rows.
  bool rows(const std::string& name) {
    if (rows_ < 0 || !table_.step)
      refuse(fmt::format("found \"ITEM: {}\" before ITEM: TIMESTEP and ITEM: NUMBER OF ...",
                         name.substr(0, 60)));
    std::vector<std::string_view> words;
    split(name, ' ', words);
    if (words.empty())
      refuse("found \"ITEM:\" without a name, expected ATOMS or ENTRIES behind it");
    std::vector<std::string> columns(words.begin() + 1, words.end());
    // "id, x, y": a sign between the names is none of theirs.
    for (std::string& column : columns)
      if (column.size() > 1 && column.back() == ',') column.pop_back();
    if (!columns_ || *columns_ != columns)
      columns_ = std::make_shared<const std::vector<std::string>>(columns);
    table_.columns = columns_;
    table_.kind = words.front() == "ATOMS" ? TableKind::grains : TableKind::contacts;
    table_.header_line = lines_.line();
    table_.first = lines_.place();
    table_.rows = rows_;
    std::string_view line;
    for (long long n = 0; n < rows_; ++n) {
      bool there = lines_.next(line);
      while (there && trimmed(line).empty()) there = lines_.next(line);
      if (there && !trimmed(line).starts_with("ITEM:") && !(n + 1 == rows_ && lines_.unfinished()))
        continue;
      truncated_ = fmt::format(
          "{}: truncated: step {} has {} rows announced, {} there{}", lines_.where(), *table_.step,
          rows_, n, there && n + 1 == rows_ ? " (the last one ends without a line end)" : "");
      return false;
    }
    table_.time = time_;
    found_.push_back(table_);
    // LAMMPS writes the time of a step before its number, others behind it.
    time_.reset();
    table_.step.reset();
    open_ = false;
    rows_ = -1;
    return true;
  }

  Lines lines_;
  ForeignTable table_;
  long long rows_ = -1;
  std::optional<double> time_;
  std::shared_ptr<const dem::Cell<3>> box_;  // the last that was met
  bool open_ = false;                        ///< a step has begun and its rows have not been met
  std::shared_ptr<const std::vector<std::string>> columns_;
  std::vector<ForeignTable> found_;
  std::string truncated_;
};

}  // namespace

std::vector<ForeignTable> scan_dump(const std::string& file, ColumnNames&) {
  return DumpScan(file).tables();
}

std::vector<std::pair<std::string, std::string>> dump_columns(
    const std::vector<std::pair<std::string, std::string>>& contact) {
  std::vector<std::pair<std::string, std::string>> columns = {
      {"id", "id"},         {"x", "x"},
      {"y", "y"},           {"z", "z"},
      {"xu", "xu"},         {"yu", "yu"},
      {"zu", "zu"},         {"xs", "xs"},
      {"ys", "ys"},         {"zs", "zs"},
      {"xsu", "xsu"},       {"ysu", "ysu"},
      {"zsu", "zsu"},       {"ix", "ix"},
      {"iy", "iy"},         {"iz", "iz"},
      {"vx", "vx"},         {"vy", "vy"},
      {"vz", "vz"},         {"spin", "omegaz"},
      {"spin_x", "omegax"}, {"spin_y", "omegay"},
      {"qw", "quatw"},      {"qx", "quati"},
      {"qy", "quatj"},      {"qz", "quatk"},
      {"radius", "radius"}, {"diameter", "diameter"},
      {"mass", "mass"},     {"density", "density"},
  };
  columns.insert(columns.end(), contact.begin(), contact.end());
  return columns;
}

}  // namespace grainfield::coupling
