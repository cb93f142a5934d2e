// Extended XYZ, as OVITO and ASE write it: for every state the number of grains, a line of
// key=value with Properties=NAME:TYPE:COUNT:... that names the columns, and a row for each grain.
// Format: https://github.com/libAtoms/extxyz, "Extended XYZ specification".
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <stdexcept>

#include "coupling/import/format.h"
#include "coupling/import/synonyms.h"
#include "dem/shared/number.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {
namespace {

using Keys = std::map<std::string, std::string>;  // keys in lower case

std::string in_lower_case(std::string text) {
  for (char& ch : text) ch = static_cast<char>(std::tolower(static_cast<unsigned char>(ch)));
  return text;
}

// key=value, key="value with blanks", key='...', key={...}, and words without a value.
Keys keys_of(std::string_view line) {
  Keys out;
  std::size_t at = 0;
  const auto is_blank = [](char ch) { return ch == ' ' || ch == '\t'; };
  while (at < line.size()) {
    if (is_blank(line[at])) {
      ++at;
      continue;
    }
    const std::size_t end = std::min(line.find_first_of("= \t", at), line.size());
    const std::string key = in_lower_case(std::string(line.substr(at, end - at)));
    at = end;
    if (at == line.size() || line[at] != '=') {
      if (!key.empty()) out[key];
      continue;
    }
    ++at;
    const std::string_view opening = "\"'{[", closing = "\"'}]";
    const std::size_t mark = at < line.size() ? opening.find(line[at]) : std::string_view::npos;
    if (mark == std::string_view::npos) {
      const std::size_t stop = std::min(line.find_first_of(" \t", at), line.size());
      out[key] = std::string(line.substr(at, stop - at));
      at = stop;
    } else {
      const std::size_t stop = std::min(line.find(closing[mark], at + 1), line.size());
      out[key] = std::string(line.substr(at + 1, stop - at - 1));
      at = std::min(stop + 1, line.size());
    }
  }
  return out;
}

class XyzScan {
 public:
  explicit XyzScan(const std::string& file) : lines_(file) {
    table_.file = file;
    table_.kind = TableKind::grains;  // whatever forces stand beside their places
  }

  // Nothing where the file does not begin as one of XYZ.
  std::optional<std::vector<ForeignTable>> tables() {
    table_.any_names = true;
    std::vector<ForeignTable> found;
    std::string_view line;
    while (lines_.next(line)) {
      if (trimmed(line).empty()) continue;
      const std::optional<long long> count = parse_integer(trimmed(line));
      if (!count || *count < 0) {
        if (found.empty()) return std::nullopt;
        refuse(fmt::format("found \"{}\", expected the number of grains of the next state",
                           line.substr(0, 60)));
      }
      // A count alone is of another format.
      if (!lines_.next(line)) return found.empty() ? std::nullopt : std::optional(found);
      const Keys keys = keys_of(line);
      if (keys.find("properties") == keys.end()) {
        if (!found.empty()) refuse("found no Properties=..., expected those of the next state");
        refuse_plain(std::string(line));
        return std::nullopt;
      }
      set_head(keys);
      table_.rows = *count;
      table_.first = lines_.place();
      read_over(*count);
      found.push_back(table_);
      if (!table_.broken.empty()) break;
    }
    if (found.empty()) return std::nullopt;
    // One state has no step, as a table has none.
    if (found.size() == 1) found.front().step.reset();
    for (std::size_t k = 0; found.size() > 1 && k < found.size(); ++k)
      if (!all_stepped_) found[k].step = static_cast<long long>(k);
    return found;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument(fmt::format("{}: {}", lines_.where(), what));
  }

  // "N", a comment and rows "C x y z": the columns have no names.
  void refuse_plain(const std::string& comment) {
    const long long header = lines_.line();
    std::vector<std::string_view> fields;
    split(comment, ' ', fields);
    const auto is_number = [](std::string_view text) { return bool(parse_number(text)); };
    const auto known = std::count_if(fields.begin(), fields.end(), [](std::string_view name) {
      return is_known_name(std::string(name));
    });
    std::string_view row;
    // A table of CSV below its number of rows has names there.
    if (known > 1 || comment.find_first_of(",;\t") != std::string::npos || !lines_.next(row))
      return;
    split(row, ' ', fields);
    if (fields.size() < 4 || !std::all_of(fields.begin() + 1, fields.end(), is_number)) return;
    throw std::invalid_argument(
        fmt::format("{}:{}: found \"{}\" in the second line of a file of XYZ, expected names of "
                    "its {} columns, "
                    "such as Properties=species:S:1:pos:R:3:radius:R:1",
                    lines_.file(), header, comment.substr(0, 60), fields.size()));
  }

  void set_head(const Keys& keys) {
    table_.header_line = lines_.line();
    table_.columns = std::make_shared<const std::vector<std::string>>(columns_of(keys));
    table_.box = box_of(keys);
    table_.step.reset();
    table_.time.reset();
    for (const char* name : {"timestep", "step", "frame"})
      if (const auto at = keys.find(name); at != keys.end() && !table_.step)
        table_.step = parse_integer(at->second);
    all_stepped_ = all_stepped_ && table_.step.has_value();
    if (const auto at = keys.find("time"); at != keys.end()) {
      const auto time = parse_number(at->second);
      if (time && *time >= 0 && *time <= dem::kMostNumber) table_.time = *time;
    }
  }

  // "species:S:1:pos:R:3:radius:R:1": pos and velo are the vectors of places and velocities.
  std::vector<std::string> columns_of(const Keys& keys) const {
    std::vector<std::string_view> parts;
    const std::string& told = keys.at("properties");
    split(told, ':', parts);
    std::vector<std::string> out;
    bool good = parts.size() % 3 == 0 && !parts.empty();
    for (std::size_t k = 0; good && k < parts.size(); k += 3) {
      const auto count = parse_integer(parts[k + 2]);
      good = count && *count >= 1 && *count <= 1000;
      for (long long c = 0; good && c < *count; ++c)
        out.push_back(name_of(std::string(parts[k]), c, *count));
    }
    if (!good)
      refuse(fmt::format(
          "Properties: found \"{}\", expected NAME:TYPE:COUNT for each of them, such as "
          "species:S:1:pos:R:3:radius:R:1",
          told.substr(0, 80)));
    return out;
  }

  static std::string name_of(const std::string& name, long long component, long long count) {
    if (count == 1) return name;
    const std::string plain = in_lower_case(name);
    const bool place = plain == "pos" || plain == "position" || plain == "positions",
               velocity = plain == "velo" || plain == "vel" || plain == "velocities";
    if ((place || velocity) && component < 3)
      return fmt::format("{}{}", velocity ? "v" : "", "xyz"[component]);
    return fmt::format("{}[{}]", name, component);
  }

  // Lattice="ax ay az bx by bz cx cy cz", Origin="x y z", pbc="T T F": T where it is left out.
  std::shared_ptr<const dem::Cell<3>> box_of(const Keys& keys) const {
    const auto lattice = keys.find("lattice");
    if (lattice == keys.end()) return nullptr;
    std::vector<std::string_view> parts;
    const auto numbers_of = [&](const std::string& key, const std::string& text,
                                std::size_t count) {
      split(text, ' ', parts);
      std::vector<double> out;
      for (const std::string_view part : parts)
        if (const auto number = parse_number(part); number && std::isfinite(*number))
          out.push_back(*number);
      if (parts.size() != count || out.size() != count)
        refuse(fmt::format("{}: found \"{}\", expected {} finite numbers", key, text, count));
      return out;
    };
    dem::Cell<3> cell;
    const std::vector<double> edges = numbers_of("Lattice", lattice->second, 9);
    for (std::size_t k = 0; k < 9; ++k)
      cell.edges(static_cast<Eigen::Index>(k % 3), static_cast<Eigen::Index>(k / 3)) = edges[k];
    cell.low.setZero();
    if (const auto origin = keys.find("origin"); origin != keys.end()) {
      const std::vector<double> low = numbers_of("Origin", origin->second, 3);
      for (std::size_t k = 0; k < 3; ++k) cell.low[static_cast<Eigen::Index>(k)] = low[k];
    }
    for (bool& periodic : cell.periodic) periodic = true;
    if (const auto pbc = keys.find("pbc"); pbc != keys.end()) {
      split(pbc->second, ' ', parts);
      if (parts.size() != 3)
        refuse(fmt::format("pbc: found \"{}\", expected three of T and F", pbc->second));
      for (std::size_t a = 0; a < 3; ++a) {
        const std::string word = in_lower_case(std::string(parts[a]));
        cell.periodic[a] = word == "t" || word == "true" || word == "1";
        if (!cell.periodic[a] && word != "f" && word != "false" && word != "0")
          refuse(fmt::format("pbc: found \"{}\", expected three of T and F", pbc->second));
      }
    }
    // The edges without a period do not count, and may be left at 0.
    for (Eigen::Index a = 0; a < 3; ++a)
      if (!cell.periodic[static_cast<std::size_t>(a)] && cell.edges.col(a).isZero(0))
        cell.edges(a, a) = 1;
    if (cell.is_periodic() && !(cell.edges.determinant() > 0))
      refuse(fmt::format("Lattice: found \"{}\", expected three edges of a right-handed cell",
                         lattice->second));
    return std::make_shared<const dem::Cell<3>>(cell);
  }

  void read_over(long long count) {
    std::string_view line;
    for (long long n = 0; n < count; ++n) {
      const bool there = lines_.next(line) && !trimmed(line).empty();
      const bool cut = there && n + 1 == count && lines_.unfinished();
      if (there && !cut) continue;
      table_.broken =
          fmt::format("{}: truncated: {} rows are announced, {} are there{}", lines_.where(), count,
                      n, cut ? " (the last one ends without a line end)" : "");
      return;
    }
  }

  Lines lines_;
  ForeignTable table_;
  bool all_stepped_ = true;
};

}  // namespace

std::optional<std::vector<ForeignTable>> scan_xyz(const std::string& file) {
  return XyzScan(file).tables();
}

}  // namespace grainfield::coupling
