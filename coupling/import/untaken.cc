#include "coupling/import/untaken.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <regex>

#include "coupling/import/synonyms.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

constexpr std::size_t kMostNames = 16;  // of one line, groups
constexpr int kWallColumns = 7;         // of LAMMPS' "fix wall/gran ... contacts", at least

// What names may tell of. A column is not missed where one of `instead` was taken.
struct Meaning {
  const char* what;
  std::regex names;  // of plain names
  std::vector<std::string> instead;
};

const std::vector<Meaning>& meanings_of_grains() {
  static const std::vector<Meaning> all{
      {"angular velocities",
       std::regex("omega.*|ang(ular)?vel.*|rotvel.*|spin.*|w[xyz0-3]"),
       {"spin", "spin_x", "spin_y"}},
      {"velocities",
       std::regex("v[xyz0-3]?|vel.*|lin(ear)?vel.*|[xyz]vel.*|translationalvel.*"),
       {"vx", "vy"}},
      {"images",
       std::regex("i[xyz0-2]?|images?[xyz0-3]?|imageflags?[xyz0-3]?|[xyz]u|[xyz]?unwrap.*"),
       {"ix", "iy", "iz", "xu", "xsu"}},
      {"orientations",
       std::regex("q[wxyzijk0-4]|quat.*|orient.*|euler.*|rot(ation)?(matrix|vector)?"
                  "[xyz0-9]*|theta|angle[xyz0-9]*"),
       {"qw", "angle"}},
      {"units", std::regex("units?|unitsystem|scal(e|ing)(factor)?"), {}},
  };
  return all;
}

const std::vector<Meaning>& meanings_of_contacts() {
  static const std::vector<Meaning> all{
      {"torques", std::regex(".*torque.*|.*moment|.*moment[xyz0-9]|tq[xyz0-9]|m[xyz]"), {}},
      {"forces",
       std::regex("f[ntsvecdabr]?[xyz0-9]?|f[xyz][ntsr]|.*force.*|.*shear.*|.*tang(ential)?.*"),
       {}},
      {"units", std::regex("units?|unitsystem|scal(e|ing)(factor)?"), {}},
  };
  return all;
}

// The name of a size, which the components of a force tell, too.
bool is_size_of_force(const std::string& plain) {
  static const std::regex sizes(
      "f|force|(f|force)(tot(al)?|abs|mag(nitude)?|norm|len(gth)?)|"
      "(abs|tot(al)?|mag(nitude)?)(f|force)|(contact|total)force"
      "(mag(nitude)?)?");
  return std::regex_match(plain, sizes);
}

struct Component {
  std::string stem;
  int number = 0;
};

// "c_p[3]"
std::optional<Component> component_of(const std::string& name) {
  const std::size_t open = name.rfind('[');
  if (open == std::string::npos || open == 0 || name.back() != ']') return std::nullopt;
  const auto number = parse_integer(name.substr(open + 1, name.size() - open - 2));
  if (!number || *number < 0 || *number > 1000) return std::nullopt;
  return Component{name.substr(0, open), static_cast<int>(*number)};
}

std::string place_of(const ForeignTable& table) {
  return table.arrays ? table.file : fmt::format("{}:{}", table.file, table.header_line);
}

// Three lengths that are a body's: a b c, or its sides.
std::vector<std::string> body_lengths(const std::map<std::string, std::string>& names) {
  for (const auto& three : {std::array{"a", "b", "c"}, std::array{"rx", "ry", "rz"},
                            std::array{"ax", "ay", "az"}, std::array{"length", "width", "height"},
                            std::array{"lx", "ly", "lz"}, std::array{"dx", "dy", "dz"}}) {
    std::vector<std::string> out;
    for (const char* name : three)
      if (const auto at = names.find(name); at != names.end()) out.push_back(at->second);
    if (out.size() == 3) return out;
  }
  return {};
}

// Columns of a fix of LAMMPS that are a wall's contacts: "f_floor[1]" to [7].
std::vector<std::string> fixes_of_walls(const std::vector<std::string>& names) {
  std::map<std::string, int> counts;
  for (const std::string& name : names)
    if (const auto part = component_of(name); part && part->stem.starts_with("f_"))
      counts[part->stem] += part->number <= kWallColumns ? 1 : 0;
  std::vector<std::string> out;
  for (const auto& [stem, count] : counts)
    if (count == kWallColumns) out.push_back(stem);
  return out;
}

}  // namespace

std::string plain_untaken_name(const ForeignTable& table, const std::string& name) {
  const bool made = table.prefixes && name.size() > 2 && name[1] == '_' &&
                    std::string_view("cfvdi").find(name[0]) != std::string_view::npos;
  return plain_column_name(made ? name.substr(2) : name);
}

std::string grouped_names(const std::vector<std::string>& names) {
  std::vector<std::string> groups;
  std::size_t left = 0;
  for (std::size_t k = 0; k < names.size();) {
    std::size_t last = k;
    const auto first = component_of(names[k]);
    while (first && last + 1 < names.size()) {
      const auto next = component_of(names[last + 1]);
      if (!next || next->stem != first->stem ||
          next->number != first->number + static_cast<int>(last + 1 - k))
        break;
      ++last;
    }
    if (groups.size() == kMostNames)
      left += last + 1 - k;
    else
      groups.push_back(last == k ? names[k]
                                 : fmt::format("{}[{}..{}]", first->stem, first->number,
                                               first->number + static_cast<int>(last - k)));
    k = last + 1;
  }
  return fmt::format("{}{}", fmt::join(groups, " "),
                     left == 0 ? "" : fmt::format(" and {} more", left));
}

UntakenColumns untaken_columns(const ForeignTable& table, const TableColumns& columns,
                               TableKind kind) {
  UntakenColumns out;
  // Names in memory are ours; a format without names of its own has fixed columns.
  if (!table.any_names) return out;
  const std::vector<std::string> names = columns.untaken();
  if (names.empty()) return out;
  out.note = fmt::format("{}: columns that are not taken: {}", table.file, grouped_names(names));
  const bool grains = kind == TableKind::grains;
  const auto& meanings = grains ? meanings_of_grains() : meanings_of_contacts();
  std::vector<std::string> told;
  for (const Meaning& meaning : meanings) {
    if (kind == TableKind::walls) break;
    if (std::any_of(meaning.instead.begin(), meaning.instead.end(),
                    [&](const std::string& ours) { return columns.has(ours); }))
      continue;
    std::vector<std::string> some;
    for (const std::string& name : names) {
      const std::string plain = plain_untaken_name(table, name);
      const bool size = !grains && is_size_of_force(plain);
      if (!size && std::regex_match(plain, meaning.names) && !columns.chose_of(name))
        some.push_back(name);
    }
    if (!some.empty()) told.push_back(fmt::format("of {}: {}", meaning.what, grouped_names(some)));
  }
  if (grains) {
    std::map<std::string, std::string> by_plain;
    for (const std::string& name : names) by_plain[plain_untaken_name(table, name)] = name;
    if (const auto lengths = body_lengths(by_plain); !lengths.empty())
      told.push_back(fmt::format("of shapes: {}", fmt::join(lengths, " ")));
    for (const std::string& fix : fixes_of_walls(names))
      out.warnings.push_back(fmt::format(
          "{}: {}[1..{}] are not taken: they look like contacts with a wall, which --wall "
          "NAME:AXIS=POSITION:fix={} takes",
          place_of(table), fix, kWallColumns, fix));
  }
  if (!told.empty())
    out.warnings.push_back(fmt::format(
        "{}: columns are not taken though their names tell {} (--column OURS=THEIRS takes them)",
        place_of(table), fmt::join(told, "; ")));
  return out;
}

}  // namespace grainfield::coupling
