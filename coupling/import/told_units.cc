#include "coupling/import/told_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "coupling/base/unit.h"
#include "coupling/import/row_text.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

constexpr std::size_t kShown = 60;  // letters of a line in a message

// Words for units that nobody writes for anything else.
bool is_foreign_unit(const std::string& word) {
  constexpr std::array symbols{"mm",  "cm",         "dm",     "um",   "\u00b5m", "\u03bcm", "nm",
                               "km",  "kN",         "mN",     "MN",   "uN",      "dyn",     "g/cm3",
                               "cgs", "g/cm^3",     "g/cc",   "t/m3", "mm/s",    "cm/s",    "um/s",
                               "mg",  "g/cm\u00b3", "kg/mm3", "N/mm", "gf"};
  if (std::find(symbols.begin(), symbols.end(), word) != symbols.end()) return true;
  std::string lower;
  for (const char ch : word)
    lower += static_cast<char>(std::tolower(static_cast<unsigned char>(ch)));
  if (lower.ends_with('s')) lower.pop_back();
  constexpr std::array names{"micron",     "micrometer", "micrometre", "millimeter", "millimetre",
                             "centimeter", "centimetre", "nanometer",  "nanometre",  "inche",
                             "inch",       "dyne",       "kilonewton"};
  return std::find(names.begin(), names.end(), lower) != names.end();
}

// "-", "m", "[mm]" under the names.
std::optional<std::string> unit_in(std::string value, const std::vector<std::string>& known) {
  if (value.size() > 2 && std::string("([{").find(value.front()) != std::string::npos)
    value = std::string(trimmed(std::string_view(value).substr(1, value.size() - 2)));
  for (const char* none :
       {"", "-", "--", "1", "#", "no.", "No.", "number", "integer", "int", "none"})
    if (value == none) return "";
  if (parse_unit(value) || std::find(known.begin(), known.end(), value) != known.end())
    return value;
  return std::nullopt;
}

// Without "units:" before it.
std::string_view without_word(std::string_view line) {
  line = trimmed(line);
  for (const std::string_view word : {"units", "Units", "UNITS", "unit", "Unit"}) {
    if (!line.starts_with(word)) continue;
    const std::string_view behind = trimmed(line.substr(word.size()));
    if (behind.starts_with(':') || behind.starts_with('=')) return trimmed(behind.substr(1));
    return behind;
  }
  return line;
}

}  // namespace

std::string foreign_unit_in(const std::string& line) {
  bool number = false;
  std::string word;
  for (std::size_t k = 0; k <= line.size(); ++k) {
    const char ch = k < line.size() ? line[k] : ' ';
    if (std::string_view(" \t,;:=()[]{}\"'|").find(ch) == std::string_view::npos) {
      word += ch;
      continue;
    }
    if (word.empty()) {
      number = number && ch == ' ';  // "Packing 3 (cm)" is no quantity
      continue;
    }
    if (word.back() == '.') word.pop_back();
    if (!number && is_foreign_unit(word)) return word;
    number = parse_number(word).has_value();
    word.clear();
  }
  return "";
}

std::optional<std::vector<std::string>> units_row(const std::string& line, char separator,
                                                  std::size_t count,
                                                  const std::vector<std::string>& known) {
  for (const char parting : {separator, ' '}) {
    RowParts parts;
    std::vector<std::string> out;
    bool any = false, good = true;
    std::size_t last = 0;
    for (const std::string_view value : parts.of(without_word(line), parting)) {
      const auto unit = unit_in(std::string(value), known);
      good = good && unit;
      any = any || (unit && !unit->empty());
      out.push_back(unit.value_or(""));
      if (!value.empty()) last = out.size();
    }
    if (!good || !any || last > count || (parting == ' ' && last != count)) continue;
    out.resize(count);
    return out;
  }
  return std::nullopt;
}

std::vector<std::string> names_with_units(std::vector<std::string> names,
                                          const std::vector<std::string>& units) {
  for (std::size_t k = 0; k < std::min(names.size(), units.size()); ++k)
    if (!units[k].empty()) names[k] += fmt::format(" ({})", units[k]);
  return names;
}

std::string unit_remark(const std::string& file, long long line, const std::string& text) {
  const std::string unit = foreign_unit_in(text);
  if (unit.empty()) return "";
  return fmt::format("{}:{}: found the unit {} in \"{}\"", file, line, unit,
                     trimmed(std::string_view(text).substr(0, kShown)));
}

}  // namespace grainfield::coupling
