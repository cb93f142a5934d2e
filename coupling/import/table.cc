#include "coupling/import/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "continuum/model.h"
#include "coupling/import/row_text.h"
#include "coupling/import/synonyms.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

// "-fx", "|fx|", "x*", "dx/dt": something else than the name without them.
bool has_signs(const std::string& name) {
  const auto sign = [](char ch) {
    return std::isalnum(static_cast<unsigned char>(ch)) == 0 &&
           std::string_view(" _-.:#[]").find(ch) == std::string_view::npos;
  };
  return name.starts_with('-') || std::any_of(name.begin(), name.end(), sign);
}

// "v[0]", "v:0"
bool is_component(const std::string& name) {
  const bool bracket = name.size() > 3 && name.back() == ']' && name[name.size() - 3] == '[';
  const bool colon = name.size() > 2 && name[name.size() - 2] == ':';
  return (bracket || colon) &&
         std::isdigit(static_cast<unsigned char>(name[name.size() - (bracket ? 2 : 1)])) != 0;
}

// "c_rho" of a dump, whose first letters say what made it: "rho".
std::string without_maker(const ForeignTable& table, const std::string& name) {
  const bool made = table.prefixes && name.size() > 2 && name[1] == '_' &&
                    std::string_view("cfvid").find(name[0]) != std::string_view::npos;
  return made ? name.substr(2) : name;
}

// Whether the user or the format names a column of theirs as another of a table of the same kind.
bool is_of_another(const ColumnNames& names, const std::string& ours, const std::string& theirs) {
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls}) {
    const std::vector<OurColumn>& columns = our_columns(kind);
    const auto is_ours = [&](const OurColumn& column) { return column.name == ours; };
    if (std::none_of(columns.begin(), columns.end(), is_ours)) continue;
    for (const OurColumn& other : columns) {
      const auto candidates = names.candidates(other.name);
      if (other.name != ours &&
          std::any_of(candidates.begin(), candidates.end(),
                      [&](const auto& candidate) { return candidate.theirs == theirs; }))
        return true;
    }
  }
  return false;
}

const OurColumn* our_column(const std::string& name) {
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind))
      if (column.name == name) return &column;
  return nullptr;
}

}  // namespace

namespace {

// "x_mm", "radius/mm", "fx, kN": a unit behind a name that is ours; else the name as it is.
Heading heading_without_brackets(const std::string& text, int index) {
  const std::string_view whole = trimmed(text);
  const std::size_t sign = whole.find_last_of("_/,");
  if (sign != std::string_view::npos && sign > 0) {
    const std::string_view unit = trimmed(whole.substr(sign + 1));
    const std::string name(trimmed(whole.substr(0, sign)));
    for (const std::string_view known : {"m", "cm", "mm", "um", "\u00b5m", "\u03bcm", "nm", "kg",
                                         "g", "mg", "N", "kN", "mN", "uN", "MN"})
      if (unit == known && is_known_name(name) && name != "i" && name != "j")
        return {name, std::string(unit), index};
  }
  return {std::string(whole), "", index};
}

// Units of other systems, and ways to write units that are not ours.
bool is_unit_of_others(std::string unit) {
  for (char& ch : unit) ch = static_cast<char>(std::tolower(static_cast<unsigned char>(ch)));
  for (const char* known :
       {"in",     "inch",       "inches",      "ft",      "feet",  "foot",   "mil",
        "yd",     "lb",         "lbs",         "lbf",     "lbm",   "oz",     "t",
        "ton",    "tonne",      "kgf",         "gf",      "tf",    "kp",     "dyn",
        "psi",    "slug",       "micron",      "microns", "meter", "meters", "metre",
        "metres", "millimeter", "millimeters", "t/m3",    "t/m^3", "g/cc",   "g/ml",
        "kg/l",   "lb/ft3",     "lb/in3",      "pcf",     "in/s",  "ft/s"})
    if (unit == known) return true;
  return false;
}

// The unit of `kind` that is written like this but for capitals, "KN", "MM"; empty: none.
std::string unit_in_other_case(const std::string& unit, const std::string& like) {
  const auto lower = [](std::string text) {
    for (char& ch : text) ch = static_cast<char>(std::tolower(static_cast<unsigned char>(ch)));
    return text;
  };
  for (const char* known :
       {"m",  "cm",    "mm",     "um",    "km",     "kg",  "g",    "mg",   "N",
        "kN", "kg/m3", "kg/m^3", "g/cm3", "g/cm^3", "m/s", "mm/s", "cm/s", "rad/s",
        "m3", "mm3",   "m2",     "mm2",   "kg/m2",  "N/m", "kN/m"})
    if (lower(known) == lower(unit) && parse_unit(known)->kind == parse_unit(like)->kind)
      return known;
  return "";
}

}  // namespace

Heading heading_of(const std::string& text, int index) {
  const std::size_t open = text.find_last_of("([{");
  if (open == std::string::npos) return heading_without_brackets(text, index);
  const std::size_t close = text.find_first_of(")]}", open);
  // "fx (N) x1000" says more than a unit.
  if (close != std::string::npos && !trimmed(std::string_view(text).substr(close + 1)).empty())
    return {std::string(trimmed(text)), "", index};
  const std::string_view all = text;
  const std::string_view inner = trimmed(all.substr(open + 1, close - open - 1));
  const bool whole = inner.find_first_not_of("0123456789") == std::string_view::npos;
  if (whole && text[open] == '[' && open > 0 && text[open - 1] != ' ')
    return {std::string(trimmed(text)), "", index};
  return {std::string(trimmed(all.substr(0, open))), std::string(inner), index};
}

TableColumns::TableColumns(const ForeignTable& table, ColumnNames& names)
    : table_(table), names_(names) {
  for (const std::string& column : *table.columns) {
    const int index = static_cast<int>(headings_.size());
    const bool ours = table.arrays != nullptr && !table.any_names;
    headings_.push_back(ours ? Heading{column, "", index} : heading_of(column, index));
  }
}

std::optional<Unit> TableColumns::unit_of(const std::string& ours, const Heading& heading) const {
  const OurColumn* known = our_column(ours);
  if (known == nullptr || known->unit.empty()) return std::nullopt;
  if (known->unit != "1") note_unit(known->unit, heading);
  if (heading.unit.empty()) {
    // A volume is one of the plane or of space: its table's unit is told by its reader.
    const int ten = known->unit == "m3" ? 0 : table_.units.ten_of(known->unit);
    if (ten == 0) return std::nullopt;
    return Unit{parse_unit(known->unit)->kind, ten, known->unit.starts_with("rad")};
  }
  const std::optional<Unit> unit = parse_unit(heading.unit == "-" ? "1" : heading.unit);
  for (const std::string& allowed : {known->unit, known->plane_unit})
    if (unit && unit->kind == parse_unit(allowed)->kind) return unit;
  std::string other_case;
  for (const std::string& allowed : {known->plane_unit, known->unit})
    if (const std::string found = unit_in_other_case(heading.unit, allowed); !found.empty())
      other_case = found;
  // "id [#]": what is no unit belongs to the name of a number without one.
  if (!unit && known->unit == "1") return std::nullopt;
  throw std::invalid_argument(fmt::format(
      "{}:{}: column {}: found the unit \"{}\", allowed: {}{}", table_.file, table_.header_line,
      heading.name == ours ? ours : fmt::format("{} ({})", heading.name, ours), heading.unit,
      known->unit == "1"
          ? "none, a number without a unit"
          : fmt::format("{}{} or another unit of that kind, of {}", known->unit,
                        known->plane_unit == known->unit ? "" : " (2D: " + known->plane_unit + ")",
                        known_symbols()),
      unit                  ? ""
      : !other_case.empty() ? fmt::format("; did you mean \"{}\"? (capitals count)", other_case)
      : is_unit_of_others(heading.unit)
          ? "; convert the column"
          : fmt::format("; where it is no unit: --column '{}={}'", ours,
                        (*table_.columns)[static_cast<std::size_t>(heading.index)])));
}

void TableColumns::note_unit(const std::string& unit, const Heading& heading) const {
  Told& told = told_[unit];
  if (heading.unit.empty()) {
    told.bare.push_back(heading.name);
    return;
  }
  const std::optional<Unit> parsed = parse_unit(heading.unit);
  if (parsed && parsed->ten != table_.units.ten_of(unit) && told.name.empty()) {
    told.name = heading.name;
    told.unit = heading.unit;
  }
}

std::string TableColumns::require_units() const {
  for (const auto& [unit, told] : told_) {
    if (told.name.empty() || told.bare.empty()) continue;
    std::vector<std::string> bare = told.bare;
    std::sort(bare.begin(), bare.end());
    bare.erase(std::unique(bare.begin(), bare.end()), bare.end());
    // Points of VTK cannot tell a unit.
    if (table_.arrays != nullptr)
      return fmt::format(
          "{}: {} is in {}, and {} without a unit: they are read in {} (--units changes it)",
          table_.file, told.name, told.unit, fmt::join(bare, ", "),
          table_.units.name.empty() || table_.units.is_si() ? unit : table_.units.name);
    throw std::invalid_argument(fmt::format(
        "{0}:{1}: found the unit {2} of {3} and none of {4}, expected one of each of them, such as "
        "\"{5} ({2})\" or \"{5} ({6})\"",
        table_.file, table_.header_line, told.unit, told.name, fmt::join(bare, ", "), bare.front(),
        unit));
  }
  return "";
}

std::vector<std::string> TableColumns::untaken() const {
  std::vector<std::string> out;
  for (const Heading& heading : headings_)
    if (!heading.name.empty() && taken_.find(heading.index) == taken_.end())
      out.push_back(heading.name);
  return out;
}

bool TableColumns::chose_of(const std::string& name) const {
  const std::string stem = name.substr(0, name.find('['));
  return stem.size() < name.size() &&
         std::any_of(headings_.begin(), headings_.end(), [&](const Heading& heading) {
           return heading.name.starts_with(stem + "[") && names_.claims(heading.name) &&
                  taken_.find(heading.index) != taken_.end();
         });
}

bool TableColumns::tells_units() const {
  return std::any_of(headings_.begin(), headings_.end(), [&](const Heading& heading) {
    return !heading.unit.empty() && taken_.find(heading.index) != taken_.end();
  });
}

std::vector<std::string> TableColumns::misspelled() const {
  std::vector<std::string> out, ours;
  if (table_.arrays != nullptr) return out;  // the reader of arrays refuses such names
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind)) ours.push_back(column.name);
  for (const Heading& heading : headings_) {
    if (heading.name.size() < 4 || is_known_name(heading.name) || names_.claims(heading.name) ||
        taken_.find(heading.index) != taken_.end())
      continue;
    if (const std::string meant = continuum::misspelt(heading.name, ours); !meant.empty())
      out.push_back(fmt::format("{}:{}: the column \"{}\" is not used; nearest: {}", table_.file,
                                table_.header_line, heading.name, meant));
  }
  return out;
}

// "3.6", or "3.6 mm" in a unit of our column's kind, in SI. Nothing for any other text.
std::optional<double> TableColumns::constant_of(const std::string& ours,
                                                const std::string& text) const {
  const OurColumn* known = our_column(ours);
  if (const auto number = parse_number(text)) {
    const bool scaled = known != nullptr && !table_.units.is_si() &&
                        (known->unit == "m3" || table_.units.ten_of(known->unit) != 0);
    if (scaled && *number != 0)
      throw std::invalid_argument(
          fmt::format("--column {}={}: found a number without a unit beside --units, expected one "
                      "behind a blank, of the kind {}",
                      ours, text, known->unit));
    return number;
  }
  const std::size_t blank = text.find(' ');
  if (known == nullptr || known->unit.empty() || blank == std::string::npos) return std::nullopt;
  const std::optional<Unit> unit = parse_unit(text.substr(blank + 1));
  for (const std::string& allowed : {known->unit, known->plane_unit})
    if (unit && unit->kind == parse_unit(allowed)->kind) return in_si(text.substr(0, blank), *unit);
  return std::nullopt;
}

std::vector<Heading>::const_iterator TableColumns::plainly(const std::string& ours) const {
  const auto none = headings_.end();
  if (!table_.any_names) return none;
  const Synonyms& known = synonyms_of(ours);
  std::vector<std::string> wanted = known.sure;
  wanted.push_back(plain_column_name(ours));
  const auto is_in = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::vector<std::string> all;
  for (const Heading& heading : headings_) all.push_back(plain_column_name(heading.name));
  auto found = none;
  for (auto at = headings_.begin(); at != none; ++at) {
    if (has_signs(at->name) || is_row_number(ours, *at)) continue;
    const std::string plain = counted_from_zero(plain_column_name(at->name), all);
    // The components of a vector: "v[0]" is a velocity's, "v0" may be anything.
    if (!is_in(wanted, plain) && !(is_component(at->name) && is_in(known.components, plain)))
      continue;
    // Ix, Iy, Iz are moments of inertia.
    const bool flag = ours == "ix" || ours == "iy" || ours == "iz";
    if (flag && at->name.front() == 'I') continue;
    // "v_x" of a dump is a variable's, not a velocity.
    if (without_maker(table_, at->name) != at->name) continue;
    if (names_.is_taken_for_another(ours, at->name, true) ||
        names_.is_taken_for_another(ours, table_.columns->at(static_cast<std::size_t>(at->index)),
                                    true))
      continue;
    if (found != none) return none;
    found = at;
  }
  return found;
}

std::vector<std::string> TableColumns::names() const {
  std::vector<std::string> out;
  for (const Heading& heading : headings_) out.push_back(heading.name);
  return out;
}

// "i,id1,id2,...": the number of the row, where other columns name both bodies and no j is there.
bool TableColumns::is_row_number(const std::string& ours, const Heading& heading) const {
  if (ours != "i" || !table_.any_names || plain_column_name(heading.name) != "i") return false;
  const auto there = [&](const std::string& plain) {
    return std::any_of(headings_.begin(), headings_.end(), [&](const Heading& other) {
      return plain_column_name(other.name) == plain;
    });
  };
  if (there("j")) return false;
  // The names of the first body and of the second are in one order.
  const std::vector<std::string>&first = synonyms_of("i").sure, &second = synonyms_of("j").sure;
  for (std::size_t k = 0; k < std::min(first.size(), second.size()); ++k)
    if (there(first[k]) && there(second[k])) return true;
  return false;
}

bool TableColumns::has(const std::string& ours) const { return bool(look_up(ours)); }

ForeignColumn TableColumns::find(const std::string& ours) const {
  ForeignColumn column = look_up(ours);
  if (column.index >= 0) taken_.insert(column.index);
  return column;
}

ForeignColumn TableColumns::look_up(const std::string& ours) const {
  for (const auto& candidate : names_.candidates(ours)) {
    const auto& columns = *table_.columns;
    const auto is_theirs = [&](const Heading& heading) {
      return heading.name == candidate.theirs ||
             columns[static_cast<std::size_t>(heading.index)] == candidate.theirs;
    };
    if (!candidate.chosen && names_.is_taken_for_another(ours, candidate.theirs, false)) continue;
    const auto at = std::find_if(headings_.begin(), headings_.end(), is_theirs);
    if (!candidate.chosen && at != headings_.end() && is_row_number(ours, *at)) continue;
    std::optional<double> constant;
    if (at == headings_.end() && candidate.chosen) constant = constant_of(ours, candidate.theirs);
    if (at == headings_.end() && !constant) continue;
    if (constant && !std::isfinite(*constant))
      throw std::invalid_argument(fmt::format(
          "--column {}={}: expected a column or a finite number", ours, candidate.theirs));
    if (std::count_if(at, headings_.end(), is_theirs) > 1)
      throw std::invalid_argument(fmt::format("{}:{}: column \"{}\" is there twice, allowed: once",
                                              table_.file, table_.header_line, candidate.theirs));
    if (candidate.chosen) names_.mark_used(ours, candidate.theirs);
    if (at == headings_.end()) return {ours, -1, constant, std::nullopt};
    // A name that was chosen in full may hold any bracket: "x (centroid)".
    Heading heading = *at;
    const bool full =
        candidate.chosen && columns[static_cast<std::size_t>(at->index)] == candidate.theirs;
    if (full && !parse_unit(heading.unit) && !is_unit_of_others(heading.unit)) heading.unit.clear();
    return {ours, at->index, std::nullopt, unit_of(ours, heading)};
  }
  const auto at = plainly(ours);
  if (at == headings_.end()) return {ours, -1, std::nullopt, std::nullopt};
  if (plain_column_name(at->name) != plain_column_name(ours))
    names_.mark_taken(table_.file, ours, at->name);
  return {ours, at->index, std::nullopt, unit_of(ours, *at)};
}

std::string TableColumns::suggestion(const std::string& ours) const {
  // What is another column of ours, or taken already, is not meant.
  std::vector<std::string> left, bare;
  for (const Heading& heading : headings_) {
    const std::string& whole = (*table_.columns)[static_cast<std::size_t>(heading.index)];
    if (heading.name.empty() || taken_.find(heading.index) != taken_.end() ||
        is_of_another(names_, ours, heading.name))
      continue;
    left.push_back(whole);
    bare.push_back(without_maker(table_, whole));
  }
  // "c_rho" of a dump is called rho.
  const auto meaning = [&](const std::string& what) {
    const std::string found = same_meaning(what, bare);
    const auto at = std::find(bare.begin(), bare.end(), found);
    return found.empty() ? found : left[static_cast<std::size_t>(at - bare.begin())];
  };
  std::string nearest = meaning(ours);
  // What would do instead of ours, under its own name.
  for (const auto& [other, instead] :
       {std::pair<std::string, std::string>{"radius", "diameter"}, {"mass", "density"}}) {
    if (ours != other || !nearest.empty()) continue;
    nearest = meaning(instead);
    if (!nearest.empty()) nearest += fmt::format(" (--column {}={})", instead, nearest);
  }
  if (!nearest.empty()) return "nearest: " + nearest;
  std::erase_if(
      left, [&](const std::string& name) { return is_known_name(name) || names_.claims(name); });
  nearest = continuum::misspelt(ours, left);
  if (!nearest.empty()) return "nearest: " + nearest;
  return left.empty() ? "" : fmt::format("not used so far: {}", fmt::join(left, " "));
}

void TableColumns::missing(const std::string& what, const std::string& option,
                           const std::string& argument) const {
  const auto& columns = *table_.columns;
  const std::string found = columns.empty() ? "none" : fmt::format("{}", fmt::join(columns, " "));
  // Names in memory are ours: none is another's word for the one that is missing.
  if (table_.arrays != nullptr && !table_.any_names)
    throw std::invalid_argument(fmt::format("{}: no \"{}\"; found: {}{}", table_.file, what, found,
                                            argument.empty() ? "" : "; " + argument));
  std::string near = suggestion(what);
  if (what == "y" && has("x") && has("z"))
    near = "a plane of x and z: --dim 2 --column y=z --column fy=fz, and walls across y";
  throw std::invalid_argument(
      fmt::format("{}:{}: no column \"{}\"; found: {}{}; other names by --column {}=THEIRS{}",
                  table_.file, table_.header_line, what, found, near.empty() ? "" : "; " + near,
                  what, option.empty() ? "" : "; " + option));
}

void TableColumns::require_all(const std::vector<std::vector<std::string>>& wanted) const {
  std::vector<std::string> lacking, hints;
  for (const std::vector<std::string>& names : wanted) {
    if (std::any_of(names.begin(), names.end(), [&](const auto& name) { return has(name); }))
      continue;
    lacking.push_back(names.front());
    if (const std::string near = suggestion(names.front()); near.starts_with("nearest: "))
      hints.push_back(fmt::format("{} ({})", names.front(), near.substr(9)));
  }
  if (lacking.size() < 2 || (table_.arrays != nullptr && !table_.any_names)) return;
  // Columns of a compute have numbers alone: which is which, the user must say.
  const bool numbered = std::any_of(table_.columns->begin(), table_.columns->end(),
                                    [](const auto& name) { return name.ends_with("[1]"); });
  throw std::invalid_argument(fmt::format(
      "{}:{}: no columns \"{}\"; found: {}{}; other names by --column OURS=THEIRS{}", table_.file,
      table_.header_line, fmt::join(lacking, "\", \""), fmt::join(*table_.columns, " "),
      hints.empty() ? "" : fmt::format("; nearest: {}", fmt::join(hints, ", ")),
      numbered ? ", such as --column 'i,j=c_ids[1..2]'" : ""));
}

ForeignColumn TableColumns::need(const std::string& ours) const {
  ForeignColumn column = find(ours);
  if (!column) missing(ours);
  return column;
}

ForeignColumn TableColumns::peek_theirs(const std::string& theirs) const {
  for (const Heading& heading : headings_)
    if (heading.name == theirs)
      return {theirs, heading.index, std::nullopt, parse_unit(heading.unit)};
  return {};
}

ForeignColumn TableColumns::need_theirs(const std::string& theirs, const std::string& like) const {
  const auto& columns = *table_.columns;
  const auto at = std::find_if(headings_.begin(), headings_.end(), [&](const Heading& heading) {
    return heading.name == theirs || columns[static_cast<std::size_t>(heading.index)] == theirs;
  });
  if (at == headings_.end())
    throw std::invalid_argument(fmt::format(
        "{}:{}: no column \"{}\"; found: {}; nearest: {}", table_.file, table_.header_line, theirs,
        fmt::join(columns, " "), continuum::nearest(theirs, columns)));
  taken_.insert(at->index);
  return {theirs, at->index, std::nullopt, unit_of(like, *at)};
}

}  // namespace grainfield::coupling
