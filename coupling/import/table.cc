#include "coupling/import/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "continuum/model.h"
#include "coupling/import/synonyms.h"
#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

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

// "-fx", "|fx|", "x*", "dx/dt": something else than the name without them.
bool has_signs(const std::string& name) {
  const auto sign = [](char ch) {
    return std::isalnum(static_cast<unsigned char>(ch)) == 0 &&
           std::string_view(" _-.:#[]").find(ch) == std::string_view::npos;
  };
  return name.starts_with('-') || std::any_of(name.begin(), name.end(), sign);
}

const OurColumn* our_column(const std::string& name) {
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind))
      if (column.name == name) return &column;
  return nullptr;
}

std::vector<std::string> all_our_names() {
  std::vector<std::string> names;
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind)) names.push_back(column.name);
  return names;
}

}  // namespace

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
      throw std::invalid_argument(fmt::format("--column {}: unknown name \"{}\"; did you mean {}?",
                                              text, ours[k], continuum::nearest(ours[k], known)));
    chosen_.emplace_back(ours[k], theirs[k]);
  }
}

bool ColumnNames::claims(const std::string& theirs) const {
  const auto names = [&](const auto& pair) { return pair.second == theirs; };
  return std::any_of(chosen_.begin(), chosen_.end(), names) ||
         std::any_of(format_.begin(), format_.end(), names);
}

void ColumnNames::mark_taken(const std::string& file, const std::string& ours,
                             const std::string& theirs) {
  auto& list = taken_[file];
  const std::string text = fmt::format("{} = {}", ours, theirs);
  if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
}

std::vector<std::string> ColumnNames::take_taken() {
  std::vector<std::string> out;
  for (const auto& [file, list] : taken_)
    out.push_back(
        fmt::format("{}: columns taken by their names: {} (--column OURS=THEIRS takes "
                    "others)",
                    file, fmt::join(list, ", ")));
  taken_.clear();
  return out;
}

std::vector<ColumnNames::Candidate> ColumnNames::candidates(const std::string& ours) const {
  std::vector<Candidate> out;
  for (const auto& [name, theirs] : chosen_)
    if (name == ours) out.push_back({theirs, true});
  for (const auto& [name, theirs] : format_)
    if (name == ours) out.push_back({theirs, false});
  return out;
}

bool ColumnNames::chose(const std::string& ours) const {
  return std::any_of(chosen_.begin(), chosen_.end(),
                     [&](const auto& pair) { return pair.first == ours; });
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
  const std::size_t open = text.find_last_of("([{");
  if (open == std::string::npos) return {std::string(trimmed(text)), "", index};
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
  if (known->unit == "m") note_length(heading);
  if (heading.unit.empty()) {
    // A volume is one of the plane or of space: its table's unit is told by its reader.
    const int ten = known->unit == "m3" ? 0 : table_.units.ten_of(known->unit);
    if (ten == 0) return std::nullopt;
    return Unit{parse_unit(known->unit)->kind, ten, known->unit.starts_with("rad")};
  }
  const std::optional<Unit> unit = parse_unit(heading.unit == "-" ? "1" : heading.unit);
  for (const std::string& allowed : {known->unit, known->plane_unit})
    if (unit && unit->kind == parse_unit(allowed)->kind) return unit;
  throw std::invalid_argument(fmt::format(
      "{}:{}: column {}: found the unit \"{}\", allowed: {}{}", table_.file, table_.header_line,
      heading.name == ours ? ours : fmt::format("{} ({})", heading.name, ours), heading.unit,
      known->unit == "1"
          ? "none, a number without a unit"
          : fmt::format("{}{} or another unit of that kind, of {}", known->unit,
                        known->plane_unit == known->unit ? "" : " (2D: " + known->plane_unit + ")",
                        known_symbols()),
      unit ? ""
           : fmt::format("; where it is no unit: --column '{}={}'", ours,
                         (*table_.columns)[static_cast<std::size_t>(heading.index)])));
}

void TableColumns::note_length(const Heading& heading) const {
  if (heading.unit.empty()) {
    // The places of a VTK file have no name that a unit could stand in.
    if (table_.arrays == nullptr) bare_lengths_.push_back(heading.name);
    return;
  }
  const std::optional<Unit> unit = parse_unit(heading.unit);
  if (unit && unit->ten != table_.units.ten_of("m") && told_length_.empty()) {
    told_length_ = heading.name;
    told_unit_ = heading.unit;
  }
}

void TableColumns::require_length_units() const {
  if (told_length_.empty() || bare_lengths_.empty()) return;
  std::vector<std::string> bare = bare_lengths_;
  std::sort(bare.begin(), bare.end());
  bare.erase(std::unique(bare.begin(), bare.end()), bare.end());
  throw std::invalid_argument(
      fmt::format("{0}:{1}: found the unit {2} of {3} and none of {4}, expected one of each "
                  "length, such as \"{5} "
                  "({2})\" or \"{5} (m)\"",
                  table_.file, table_.header_line, told_unit_, told_length_, fmt::join(bare, ", "),
                  bare.front()));
}

std::vector<std::string> TableColumns::misspelled() const {
  std::vector<std::string> out, ours;
  if (table_.arrays != nullptr) return out;  // the reader of arrays refuses such names
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind)) ours.push_back(column.name);
  for (const Heading& heading : headings_) {
    if (heading.name.size() < 4 || is_known_name(heading.name) || names_.claims(heading.name))
      continue;
    if (const std::string meant = continuum::misspelt(heading.name, ours); !meant.empty())
      out.push_back(fmt::format("{}:{}: the column \"{}\" is not used; did you mean {}?",
                                table_.file, table_.header_line, heading.name, meant));
  }
  return out;
}

// "3.6", or "3.6 mm" in a unit of our column's kind, in SI. Nothing for any other text.
std::optional<double> TableColumns::constant_of(const std::string& ours,
                                                const std::string& text) const {
  const OurColumn* known = our_column(ours);
  if (const auto number = dem::parse_number(text)) {
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
  auto found = none;
  for (auto at = headings_.begin(); at != none; ++at) {
    if (has_signs(at->name)) continue;
    const std::string plain = plain_column_name(at->name);
    if (std::find(wanted.begin(), wanted.end(), plain) == wanted.end()) continue;
    // Ix, Iy, Iz are moments of inertia.
    const bool flag = ours == "ix" || ours == "iy" || ours == "iz";
    if (flag && at->name.front() == 'I') continue;
    // "v_x" of a dump is a variable's, not a velocity.
    if (table_.prefixes && at->name.size() > 2 && at->name[1] == '_' &&
        std::string_view("cfvid").find(at->name[0]) != std::string_view::npos)
      continue;
    if (names_.claims(at->name) ||
        names_.claims(table_.columns->at(static_cast<std::size_t>(at->index))))
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
    // A name that was chosen in full may hold any bracket: "x (centroid)".
    Heading heading = *at;
    const bool full =
        candidate.chosen && columns[static_cast<std::size_t>(at->index)] == candidate.theirs;
    if (full && !parse_unit(heading.unit)) heading.unit.clear();
    return {ours, at->index, std::nullopt, unit_of(ours, heading)};
  }
  const auto at = plainly(ours);
  if (at == headings_.end()) return {ours, -1, std::nullopt, std::nullopt};
  if (plain_column_name(at->name) != plain_column_name(ours))
    names_.mark_taken(table_.file, ours, at->name);
  return {ours, at->index, std::nullopt, unit_of(ours, *at)};
}

void TableColumns::missing(const std::string& what, const std::string& option,
                           const std::string& argument) const {
  const auto& columns = *table_.columns;
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
  if (table_.arrays != nullptr && !table_.any_names)
    throw std::invalid_argument(fmt::format("{}: no \"{}\"; found: {}{}", table_.file, what, found,
                                            argument.empty() ? "" : "; " + argument));
  if (nearest.empty()) nearest = continuum::nearest(what, columns);
  throw std::invalid_argument(fmt::format(
      "{}:{}: no column \"{}\"; found: {}{} Other names by --column {}=THEIRS{}", table_.file,
      table_.header_line, what, found, nearest.empty() ? "." : "; did you mean " + nearest + "?",
      what, option.empty() ? "" : "; " + option));
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
        "{}:{}: no column \"{}\"; found: {}; did you mean {}?", table_.file, table_.header_line,
        theirs, fmt::join(columns, " "), continuum::nearest(theirs, columns)));
  return {theirs, at->index, std::nullopt, unit_of(like, *at)};
}

}  // namespace grainfield::coupling
