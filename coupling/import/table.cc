#include "coupling/import/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "continuum/model.h"
#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

// What other programs call our columns; in lower case, without "_", "-", ".", " " and units in
// brackets.
const std::vector<std::pair<std::string, std::vector<std::string>>>& other_names() {
  static const std::vector<std::pair<std::string, std::vector<std::string>>> names{
      {"id", {"particle", "particleid", "grain", "grainid", "number", "no", "index", "label"}},
      {"x", {"xpos", "posx", "positionx", "xc", "cx", "centrex", "centerx", "x1", "coordx"}},
      {"y", {"ypos", "posy", "positiony", "yc", "cy", "centrey", "centery", "x2", "coordy"}},
      {"z", {"zpos", "posz", "positionz", "zc", "cz", "centrez", "centerz", "x3", "coordz"}},
      {"radius", {"r", "rad", "rp"}},
      {"diameter", {"d", "diam", "dp"}},
      {"mass", {"m"}},
      {"density", {"rho", "rhop"}},
      {"i", {"id1", "p1", "particle1", "grain1", "first", "ida", "idi", "from"}},
      {"j", {"id2", "p2", "particle2", "grain2", "second", "idb", "idj", "to"}},
      {"fx", {"forcex", "xforce", "f1", "ftotx"}},
      {"fy", {"forcey", "yforce", "f2", "ftoty"}},
      {"fz", {"forcez", "zforce", "f3", "ftotz"}},
      {"px", {"contactx", "pointx", "cpx", "xcontact"}},
      {"py", {"contacty", "pointy", "cpy", "ycontact"}},
      {"nx", {"normalx", "xnormal"}},
      {"ny", {"normaly", "ynormal"}}};
  return names;
}

std::string plain(const std::string& name) {
  std::string out;
  for (const char ch : name.substr(0, name.find_first_of("([{"))) {
    const auto c = static_cast<unsigned char>(ch);
    if (std::isalnum(c) != 0) out += static_cast<char>(std::tolower(c));
  }
  return out;
}

// The column that other programs use for ours; empty: none.
std::string same_meaning(const std::string& ours, const std::vector<std::string>& columns) {
  std::vector<std::string> wanted{ours};
  for (const auto& [name, others] : other_names()) {
    if (name == ours) wanted.insert(wanted.end(), others.begin(), others.end());
  }
  for (const std::string& word : wanted) {
    for (const std::string& column : columns) {
      if (plain(column) == word) return column;
    }
  }
  return "";
}

// "a,c_id[1..3]" -> a, c_id[1], c_id[2], c_id[3]
std::vector<std::string> expanded(const std::string& list) {
  std::vector<std::string_view> parts;
  split(list, ',', parts);
  std::vector<std::string> out;
  for (const std::string_view part : parts) {
    const std::size_t open = part.rfind('['), dots = part.rfind("..");
    std::optional<double> first, last;
    if (open != std::string_view::npos && dots != std::string_view::npos && part.back() == ']') {
      first = dem::parse_number(part.substr(open + 1, dots - open - 1));
      last = dem::parse_number(part.substr(dots + 2, part.size() - dots - 3));
    }
    // False for nan too.
    const bool good = first && last && 0 <= *first && *first <= *last && *last <= 1000;
    if (!good) {
      out.emplace_back(part);
      continue;
    }
    for (int k = static_cast<int>(*first); k <= static_cast<int>(*last); ++k)
      out.push_back(fmt::format("{}[{}]", part.substr(0, open), k));
  }
  return out;
}

const OurColumn* our_column(const std::string& name) {
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind))
      if (column.name == name) return &column;
  return nullptr;
}

// Whether another unit of a file's lengths is its unit too.
bool is_scaled(const OurColumn& column) { return column.unit == "m" || column.unit == "m/s"; }

std::vector<std::string> all_our_names() {
  std::vector<std::string> names;
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind)) names.push_back(column.name);
  return names;
}

}  // namespace

const std::vector<OurColumn>& our_columns(TableKind kind) {
  static const std::vector<OurColumn> grains{
      {"id", "1", "whole number, each once"},
      {"x", "m", "centroid"},
      {"y", "m", "centroid"},
      {"z", "m", "centroid; 2D: may be missing"},
      {"vx", "m/s", "velocity, default 0"},
      {"vy", "m/s", "velocity, default 0"},
      {"vz", "m/s", "velocity, default 0"},
      {"angle", "rad", "rotation about z, default 0"},
      {"spin", "rad/s", "about z, default 0"},
      {"spin_x", "rad/s", "3D: about x, default 0"},
      {"spin_y", "rad/s", "3D: about y, default 0"},
      {"qw", "1", "3D: orientation, a unit quaternion; default 1, 0, 0, 0"},
      {"qx", "1", "3D: orientation"},
      {"qy", "1", "3D: orientation"},
      {"qz", "1", "3D: orientation"},
      {"radius", "m", "of a disk or sphere"},
      {"diameter", "m", "instead of radius"},
      {"mass", "kg", "2D: with an areal density"},
      {"density", "kg/m3", "instead of mass; 2D: kg/m2", "kg/m2"},
      {"inertia", "kg m2", "about the centroid; default: of a disk, sphere or polygon"},
      {"volume", "m3", "2D: m2; default: of a disk, sphere or polygon", "m2"},
      {"fixed", "1", "1: part of the apparatus, default 0"},
      {"material", "", "name; default: the only one, without a name"},
      {"outline", "m", "x1 y1;x2 y2;... of a convex polygon about (x, y), turned by angle"},
  };
  static const std::vector<OurColumn> contacts{
      {"i", "1", "id of a grain"},
      {"j", "1", "id of the other grain, or name of a wall"},
      {"wall", "1", "instead of j: name or id of a wall"},
      {"px", "m", "contact point; default: on the line of centres, in the overlap's middle"},
      {"py", "m", "contact point"},
      {"pz", "m", "contact point"},
      {"nx", "1", "normal from i to j; default: along the line of centres"},
      {"ny", "1", "normal"},
      {"nz", "1", "normal"},
      {"fx", "N", "force on i"},
      {"fy", "N", "force on i"},
      {"fz", "N", "force on i"},
      {"fnx", "N", "normal part of the force on i, instead of fx"},
      {"fny", "N", "normal part"},
      {"fnz", "N", "normal part"},
      {"ftx", "N", "tangential part of the force on i"},
      {"fty", "N", "tangential part"},
      {"ftz", "N", "tangential part"},
      {"friction", "1", "Coulomb coefficient of the contact; default nan (unknown)"},
      {"spring", "N", "elastic part of the tangential force; default nan (unknown)"},
      {"sx", "N", "3D: elastic part of the tangential force on i; default nan (unknown)"},
      {"sy", "N", "3D: elastic part"},
      {"sz", "N", "3D: elastic part"},
      {"sliding", "1", "1: at the Coulomb limit; default: told from friction"},
  };
  static const std::vector<OurColumn> walls{
      {"name", "", "floor, left, right or any other"},
      {"x", "m", "a point of the wall"},
      {"y", "m", "a point of the wall"},
      {"z", "m", "a point of the wall"},
      {"nx", "1", "normal into the grains"},
      {"ny", "1", "normal"},
      {"nz", "1", "normal"},
      {"friction", "1", "grain against wall; default nan (unknown)"},
      {"material", "", "name; default: that of each grain, with the friction"},
  };
  static const std::vector<OurColumn> none;
  switch (kind) {
    case TableKind::grains:
      return grains;
    case TableKind::contacts:
      return contacts;
    case TableKind::walls:
      return walls;
    case TableKind::unknown:
      break;
  }
  return none;
}

ColumnNames::ColumnNames(std::vector<std::pair<std::string, std::string>> format)
    : format_(std::move(format)) {}

void ColumnNames::choose(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    throw std::invalid_argument(
        fmt::format("--column: found \"{}\", expected OURS=THEIRS, such as radius=c_r", text));
  const std::vector<std::string> ours = expanded(text.substr(0, equals)),
                                 theirs = expanded(text.substr(equals + 1)),
                                 known = all_our_names();
  if (ours.size() != theirs.size())
    throw std::invalid_argument(fmt::format("--column {}: {} names on the left, {} on the right",
                                            text, ours.size(), theirs.size()));
  for (std::size_t k = 0; k < ours.size(); ++k) {
    if (std::find(known.begin(), known.end(), ours[k]) == known.end())
      throw std::invalid_argument(fmt::format("--column {}: unknown name \"{}\"; nearest: {}", text,
                                              ours[k], continuum::nearest(ours[k], known)));
    chosen_.emplace_back(ours[k], theirs[k]);
  }
}

std::vector<ColumnNames::Candidate> ColumnNames::candidates(const std::string& ours) const {
  std::vector<Candidate> out;
  for (const auto& [name, theirs] : chosen_)
    if (name == ours) out.push_back({theirs, true});
  for (const auto& [name, theirs] : format_)
    if (name == ours) out.push_back({theirs, false});
  return out;
}

void ColumnNames::mark_used(const std::string& ours, const std::string& theirs) {
  used_.insert(ours + "=" + theirs);
}

void ColumnNames::require_all_used() const {
  for (const auto& [ours, theirs] : chosen_)
    if (used_.find(ours + "=" + theirs) == used_.end())
      throw std::invalid_argument(
          fmt::format("--column {}={}: no table that needs {} has a column \"{}\"", ours, theirs,
                      ours, theirs));
}

Heading heading_of(const std::string& text, int index) {
  const std::size_t open = text.find_last_of("([");
  if (open == std::string::npos) return {std::string(trimmed(text)), "", index};
  const std::size_t close = text.find_first_of(")]", open);
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
    headings_.push_back(table.units_in_header ? heading_of(column, index)
                                              : Heading{column, "", index});
  }
}

std::optional<Unit> TableColumns::unit_of(const std::string& ours, const Heading& heading) const {
  const OurColumn* known = our_column(ours);
  if (known == nullptr || known->unit.empty()) return std::nullopt;
  if (heading.unit.empty()) {
    return is_scaled(*known) ? table_.length : std::nullopt;
  }
  const std::optional<Unit> unit = parse_unit(heading.unit == "-" ? "1" : heading.unit);
  for (const std::string& allowed : {known->unit, known->plane_unit})
    if (unit && unit->kind == parse_unit(allowed)->kind) return unit;
  throw std::invalid_argument(fmt::format(
      "{}:{}: column {}: found the unit \"{}\", allowed: {}", table_.file, table_.header_line,
      heading.name == ours ? ours : fmt::format("{} ({})", heading.name, ours), heading.unit,
      known->unit == "1"
          ? "none, a number without a unit"
          : fmt::format("{}{} or another unit of that kind, of {}", known->unit,
                        known->plane_unit == known->unit ? "" : " (2D: " + known->plane_unit + ")",
                        known_symbols())));
}

// "3.6", or "3.6 mm" in a unit of our column's kind, in SI. Nothing for any other text.
std::optional<double> TableColumns::constant_of(const std::string& ours,
                                                const std::string& text) const {
  const OurColumn* known = our_column(ours);
  if (const auto number = dem::parse_number(text)) {
    const bool length = known != nullptr && (is_scaled(*known) || known->unit == "m3");
    if (table_.length && length && *number != 0)
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

ForeignColumn TableColumns::find(const std::string& ours) const {
  for (const auto& candidate : names_.candidates(ours)) {
    const auto& columns = *table_.columns;
    const auto is_theirs = [&](const Heading& heading) {
      return heading.name == candidate.theirs ||
             columns[static_cast<std::size_t>(heading.index)] == candidate.theirs;
    };
    const auto at = std::find_if(headings_.begin(), headings_.end(), is_theirs);
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
    return {ours, at->index, std::nullopt, unit_of(ours, *at)};
  }
  return {ours, -1, std::nullopt, std::nullopt};
}

void TableColumns::missing(const std::string& what, const std::string& option,
                           const std::string& argument) const {
  const auto& columns = *table_.columns;
  // LAMMPS' scaled coordinates run from 0 to 1 over the box: no lengths.
  for (const char* scaled : {"s", "su"})
    if ((what == "x" || what == "y" || what == "z") &&
        std::find(columns.begin(), columns.end(), what + scaled) != columns.end())
      throw std::invalid_argument(fmt::format(
          "{}:{}: no column \"{}\"; {}{} is in units of the box: dump x y z (or xu yu zu), in m",
          table_.file, table_.header_line, what, what, scaled));
  std::string nearest = same_meaning(what, columns);
  // What would do instead of ours, under its own name.
  for (const auto& [ours, instead] :
       {std::pair<std::string, std::string>{"radius", "diameter"}, {"mass", "density"}}) {
    if (what != ours || !nearest.empty()) continue;
    nearest = same_meaning(instead, columns);
    if (!nearest.empty()) nearest += fmt::format(" (--column {}={})", instead, nearest);
  }
  const std::string found = columns.empty() ? "none" : fmt::format("{}", fmt::join(columns, " "));
  // Names in memory are ours: none is another's word for the one that is missing.
  if (table_.arrays != nullptr)
    throw std::invalid_argument(fmt::format("{}: no \"{}\"; found: {}{}", table_.file, what, found,
                                            argument.empty() ? "" : "; " + argument));
  if (nearest.empty()) nearest = continuum::nearest(what, columns);
  throw std::invalid_argument(fmt::format(
      "{}:{}: no column \"{}\"; found: {}{}; other names by --column {}=THEIRS{}", table_.file,
      table_.header_line, what, found, nearest.empty() ? "" : "; nearest: " + nearest, what,
      option.empty() ? "" : "; " + option));
}

ForeignColumn TableColumns::need(const std::string& ours) const {
  ForeignColumn column = find(ours);
  if (!column) missing(ours);
  return column;
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
  return {theirs, at->index, std::nullopt, unit_of(like, *at)};
}

const ArrayColumn* ForeignRow::array_of(const ForeignColumn& column) const {
  return arrays == nullptr || column.index < 0 ? nullptr
                                               : &(*arrays)[static_cast<std::size_t>(column.index)];
}

std::string_view ForeignRow::text(const ForeignColumn& column) const {
  if (const ArrayColumn* array = array_of(column)) {
    if (!array->words.empty()) return array->words[place];
    const double value = array->numbers[place];
    if (std::isnan(value)) return {};
    shown_ = fmt::format("{}", value);
    return shown_;
  }
  return column.index >= 0 ? fields[static_cast<std::size_t>(column.index)] : std::string_view();
}

bool ForeignRow::empty(const ForeignColumn& column) const {
  const ArrayColumn* array = array_of(column);
  if (array != nullptr && array->words.empty()) return std::isnan(array->numbers[place]);
  return !column || (!column.constant && text(column).empty());
}

std::string ForeignRow::name_of(const ForeignColumn& column) const {
  if (column.index < 0) return column.name;
  const std::string& theirs = (*columns)[static_cast<std::size_t>(column.index)];
  return theirs == column.name ? theirs : fmt::format("{} ({})", theirs, column.name);
}

void ForeignRow::refuse(const std::string& what) const {
  throw std::invalid_argument(fmt::format("{}:{}: {}", *file, line, what));
}

double ForeignRow::number(const ForeignColumn& column) const {
  if (column.constant) return *column.constant;
  const ArrayColumn* array = array_of(column);
  std::optional<double> value;
  if (array != nullptr && array->words.empty()) {
    value = array->numbers[place];
  } else {
    value = column.unit ? in_si(std::string(text(column)), *column.unit)
                        : dem::parse_number(text(column));
  }
  if (!value || !std::isfinite(*value))
    refuse(fmt::format("column {}: found \"{}\", expected a finite number", name_of(column),
                       text(column)));
  return *value;
}

long long ForeignRow::whole(const ForeignColumn& column) const {
  if (!column.constant) {
    if (const auto value = dem::parse_integer(text(column))) return *value;
  }
  const double value = number(column);
  if (value != std::floor(value) || std::abs(value) > 9e15)
    refuse(fmt::format("column {}: found \"{}\", expected a whole number",
                       column.constant ? column.name : name_of(column),
                       column.constant ? fmt::format("{}", value) : std::string(text(column))));
  return static_cast<long long>(value);
}

bool ForeignRow::flag(const ForeignColumn& column) const {
  if (empty(column)) return false;
  const double value = number(column);
  if (value != 0 && value != 1)
    refuse(fmt::format("column {}: found {}, allowed: 0, 1", name_of(column), value));
  return value != 0;
}

double ForeignRow::coefficient(const ForeignColumn& column) const {
  const double value = number(column);
  if (!(value >= 0 && value <= kMostFriction))
    refuse(fmt::format("column {}: found {}, allowed: 0 to {:g}", name_of(column), value,
                       kMostFriction));
  return value;
}

void TableReader::read_arrays(const ForeignTable& table,
                              const std::function<void(const ForeignRow&)>& take) {
  ForeignRow row;
  row.file = &table.file;
  row.columns = table.columns.get();
  row.arrays = table.arrays.get();
  for (long long n = 0; n < table.rows; ++n) {
    row.line = n;
    row.place = static_cast<std::size_t>(n);
    take(row);
  }
}

void TableReader::read(const ForeignTable& table,
                       const std::function<void(const ForeignRow&)>& take) {
  if (table.arrays) return read_arrays(table, take);
  auto& lines = files_[table.file];
  if (!lines) lines = std::make_unique<Lines>(table.file);
  lines->seek(table.first);
  ForeignRow row;
  row.file = &table.file;
  row.columns = table.columns.get();
  std::string_view line;
  for (long long n = 0; (table.rows < 0 || n < table.rows) && lines->next(line); ++n) {
    row.line = lines->line();
    if (table.rows < 0) {
      const std::string_view text = trimmed(line);
      if (text.empty() || text.front() == '#') continue;
    }
    split(line, table.separator, row.fields);
    if (row.fields.size() != table.columns->size())
      row.refuse(fmt::format("{} values where the header at line {} names {} columns",
                             row.fields.size(), table.header_line, table.columns->size()));
    take(row);
  }
}

}  // namespace grainfield::coupling
