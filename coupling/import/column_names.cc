// Names of columns that the user chooses and the format knows.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "continuum/model.h"
#include "coupling/import/row_text.h"
#include "coupling/import/table.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

// "a,c_id[1..3]" -> a, c_id[1], c_id[2], c_id[3]; a name with a comma has quotation marks.
std::vector<std::string> expanded(const std::string& list) {
  RowParts parts;
  std::vector<std::string> out;
  for (const std::string_view part : parts.of(list, ',')) {
    const std::size_t open = part.rfind('['), dots = part.rfind("..");
    std::optional<double> first, last;
    if (open != std::string_view::npos && dots != std::string_view::npos && part.back() == ']') {
      first = parse_number(part.substr(open + 1, dots - open - 1));
      last = parse_number(part.substr(dots + 2, part.size() - dots - 3));
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

std::vector<std::string> all_our_names() {
  std::vector<std::string> names;
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind)) names.push_back(column.name);
  return names;
}

// Whether both of ours are columns of grains, or of contacts, or of walls.
bool in_one_table(const std::string& one, const std::string& other) {
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls}) {
    const auto has = [&](const std::string& name) {
      return std::any_of(our_columns(kind).begin(), our_columns(kind).end(),
                         [&](const OurColumn& column) { return column.name == name; });
    };
    if (has(one) && has(other)) return true;
  }
  return false;
}

}  // namespace

ColumnNames::ColumnNames(std::vector<std::pair<std::string, std::string>> format)
    : format_(std::move(format)) {}

void ColumnNames::choose(const std::vector<std::string>& texts) {
  const std::vector<std::string> known = all_our_names();
  std::vector<std::string> unknown;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(
          fmt::format("--column: found \"{}\", expected OURS=THEIRS, such as radius=c_r", text));
    const std::vector<std::string> ours = expanded(text.substr(0, equals));
    std::vector<std::string> theirs = expanded(text.substr(equals + 1));
    // One name with a comma in it.
    if (ours.size() == 1 && theirs.size() > 1) theirs = {text.substr(equals + 1)};
    if (ours.size() != theirs.size())
      throw std::invalid_argument(fmt::format(
          "--column {}: {} names on the left, {} on the right{}", text, ours.size(), theirs.size(),
          theirs.size() > ours.size() ? "; a name with a comma in it stands in quotation marks"
                                      : ""));
    for (std::size_t k = 0; k < ours.size(); ++k) {
      if (std::find(known.begin(), known.end(), ours[k]) == known.end())
        unknown.push_back(fmt::format("--column {}: unknown name \"{}\"; nearest: {}", text,
                                      ours[k], continuum::nearest(ours[k], known)));
      chosen_.emplace_back(ours[k], theirs[k]);
    }
  }
  if (!unknown.empty()) throw std::invalid_argument(fmt::format("{}", fmt::join(unknown, "; ")));
}

bool ColumnNames::claims(const std::string& theirs) const {
  const auto names = [&](const auto& pair) { return pair.second == theirs; };
  return std::any_of(chosen_.begin(), chosen_.end(), names) ||
         std::any_of(format_.begin(), format_.end(), names);
}

bool ColumnNames::is_taken_for_another(const std::string& ours, const std::string& theirs,
                                       bool of_format) const {
  // A spring is a part of the force: the column of a tangential force may be both.
  const auto is_spring = [](const std::string& name) {
    return name == "spring" || name == "sx" || name == "sy" || name == "sz";
  };
  const auto elsewhere = [&](const auto& pair) {
    return pair.second == theirs && pair.first != ours && in_one_table(pair.first, ours) &&
           !is_spring(pair.first);
  };
  return std::any_of(chosen_.begin(), chosen_.end(), elsewhere) ||
         (of_format && std::any_of(format_.begin(), format_.end(),
                                   [&](const auto& pair) { return pair.second == theirs; }));
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
  std::vector<std::string> unused;
  for (const auto& [ours, theirs] : chosen_)
    if (used_.find(ours + "=" + theirs) == used_.end())
      unused.push_back(fmt::format("--column {}={}: no table that needs {} has a column \"{}\"",
                                   ours, theirs, ours, theirs));
  if (!unused.empty()) throw std::invalid_argument(fmt::format("{}", fmt::join(unused, "; ")));
}

}  // namespace grainfield::coupling
