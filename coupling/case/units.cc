#include "coupling/case/units.h"

#include <fmt/format.h>

#include <numbers>

#include "coupling/base/unit.h"
#include "coupling/case/study.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

std::string kind_of(const std::string& unit) {
  const std::optional<Unit> parsed = parse_unit(unit == "-" ? "1" : unit);
  return parsed ? parsed->kind : "";
}

// As keys write it, before a remark in brackets.
std::string plain(const std::string& unit) { return unit.substr(0, unit.find(" (")); }

}  // namespace

std::optional<Measure> parse_measure(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return std::nullopt;
  const std::size_t blank = text.find(' ', first);
  if (blank == std::string::npos) return std::nullopt;
  const std::string number = text.substr(first, blank - first);
  const std::optional<Unit> unit = parse_unit(text.substr(blank));
  if (!parse_number(number) || !unit) return std::nullopt;
  std::optional<double> value = times_ten(number, unit->ten);
  if (!value) return std::nullopt;
  if (unit->radians) *value *= 180 / std::numbers::pi;
  return Measure{*value, unit->kind};
}

std::string with_point(std::string text) {
  const std::string digits = "0123456789";
  const std::size_t comma = text.find(',');
  if (comma == 0 || comma == std::string::npos ||
      digits.find(text[comma - 1]) == std::string::npos ||
      text.find_first_of(digits, comma) != comma + 1) {
    return "";
  }
  const bool thousands = text.size() == comma + 4 && text.find_first_not_of("+-0") < comma;
  const std::string whole = text.substr(0, comma) + text.substr(comma + 1);
  text[comma] = '.';
  if (parse_number(text)) return thousands ? text + " or " + whole : text;
  return parse_measure(text) ? toml_text(text) : "";
}

UnitKinds kinds_of(const std::string& unit) {
  const std::string plane = kind_of(plain(unit));
  const std::string space = "(3D: ";
  const std::size_t at = unit.find(space);
  if (at == std::string::npos) return {plane, plane};
  const std::size_t start = at + space.size();
  return {plane, kind_of(unit.substr(start, unit.find(')', start) - start))};
}

std::optional<double> measured(const Key& key, const Assignment& a, const std::string& text) {
  const std::optional<Measure> measure = parse_measure(text);
  if (!measure) return std::nullopt;
  const UnitKinds allowed = kinds_of(key.unit);
  if (measure->kind != allowed.plane && measure->kind != allowed.space) {
    reject(a, key.path(),
           key.unit == "-"
               ? fmt::format("found \"{}\", expected a number without unit", text)
               : fmt::format("found \"{}\", expected a number in {}, or with a unit of that kind",
                             text, key.unit));
  }
  return measure->value;
}

std::string known_units() { return known_symbols() + "; a blank before both, as in \"3.6 mm\""; }

void check_units(const Draft& draft) {
  const bool space = dimension_of(draft.value) == 3;
  for (const auto& [path, a] : draft.last) {
    const Key* key = find_key(path);
    if (key == nullptr || key->unit == "-") continue;
    const UnitKinds kinds = kinds_of(key->unit);
    for (const Scalar& item : a.items) {
      const auto* text = std::get_if<std::string>(&item);
      const auto measure = text != nullptr ? parse_measure(*text) : std::nullopt;
      if (!measure || measure->kind == (space ? kinds.space : kinds.plane)) continue;
      reject(a, path,
             fmt::format(
                 "found \"{}\" for grains in {} dimensions, expected a number in {}, or with a "
                 "unit of that kind",
                 *text, space ? "three" : "two", key->unit));
    }
  }
}

}  // namespace grainfield::coupling
