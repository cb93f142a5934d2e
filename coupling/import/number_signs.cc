#include "coupling/import/number_signs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "coupling/import/row_text.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

// Rows that are searched, at least: on until one tells a comma or a point.
constexpr std::size_t kSearched = 1000;

// "50.000,0", "50,000.0", "50'000.0": two signs, or one that is none of decimals. Returns the sign
// of thousands, else 0.
char sign_of_thousands(std::string_view value) {
  for (const char sign : {'.', ',', '\''}) {
    const std::size_t first = value.find(sign);
    if (first == std::string_view::npos) continue;
    const std::size_t end = value.find_first_of(".,", value.rfind(sign) + 1);
    if (end == std::string_view::npos && sign != '\'') continue;
    if (!is_in_thousands(value.substr(0, end), sign)) continue;
    std::string rest(1, '0');
    if (end != std::string_view::npos) rest += value.substr(end);
    std::replace(rest.begin(), rest.end(), ',', '.');
    if (foreign_number(rest)) return sign;
  }
  return 0;
}

}  // namespace

bool is_in_thousands(std::string_view value, char sign) {
  if (value.starts_with('-') || value.starts_with('+')) value.remove_prefix(1);
  const auto is_digits = [](std::string_view part) {
    return std::all_of(part.begin(), part.end(),
                       [](unsigned char ch) { return std::isdigit(ch) != 0; });
  };
  std::size_t at = value.find(sign);
  if (at == std::string_view::npos || at == 0 || at > 3 || value.front() == '0' ||
      !is_digits(value.substr(0, at)))
    return false;
  while (at < value.size()) {
    if (value[at] != sign || value.size() < at + 4 || !is_digits(value.substr(at + 1, 3)))
      return false;
    at += 4;
  }
  return true;
}

bool is_decimal_comma(std::string_view value) {
  const std::size_t comma = value.find(',');
  if (comma == std::string_view::npos) return false;
  std::string text(value);
  text[comma] = '.';
  return parse_number(text).has_value();
}

NumberSigns number_signs(Lines& lines, const ForeignTable& table) {
  struct Sign {
    std::size_t all = 0, thousands = 0;
    std::string first;
  } comma, point;
  char thousands = 0, decimals = '.';
  lines.seek(table.first);
  std::string_view line;
  RowParts parts;
  for (std::size_t n = 0; (n < kSearched || comma.all + point.all == 0) && lines.next(line); ++n) {
    if (trimmed(line).starts_with('#')) continue;
    for (const std::string_view value : parts.of(line, table.separator, lines)) {
      const char sign = sign_of_thousands(value);
      if (sign != 0) {
        thousands = sign;
        decimals = value.find(',', value.rfind(sign)) != std::string_view::npos ? ',' : decimals;
        continue;
      }
      const bool with_comma = is_decimal_comma(value);
      const bool with_point =
          value.find('.') != std::string_view::npos && foreign_number(value).has_value();
      if (!with_comma && !with_point) continue;
      Sign& met = with_comma ? comma : point;
      if (met.all++ == 0) met.first = std::string(value);
      met.thousands += is_in_thousands(value, with_comma ? ',' : '.');
    }
  }
  NumberSigns out;
  // A number with both signs tells both.
  if (thousands != 0) {
    out.thousands = thousands;
    out.decimal_commas = thousands == '.' || (thousands == '\'' && decimals == ',');
    return out;
  }
  out.decimal_commas = comma.all > 0 && point.all == 0;
  // Beside commas and blanks points are those of decimals.
  const bool points_count = table.separator == ';' && comma.all == 0;
  const Sign& sign = out.decimal_commas ? comma : point;
  if (sign.all > 0 && sign.thousands == sign.all && (out.decimal_commas || points_count))
    out.doubt = fmt::format(
        "{}: every {} in its numbers has three digits behind it (such as {}): it is read as that "
        "of "
        "decimals; where it parts thousands, write the table without it",
        table.file, out.decimal_commas ? "comma" : "point", sign.first);
  return out;
}

}  // namespace grainfield::coupling
