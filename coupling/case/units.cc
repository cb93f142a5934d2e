#include "coupling/case/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>
#include <string_view>
#include <utility>

#include "coupling/case/study.h"
#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

// m, kg, s and angle, as powers; and a power of ten.
struct Unit {
  std::array<int, 4> powers{};
  int ten = 0;
  bool radians = false;
};

struct Symbol {
  const char* name;
  Unit unit;
  bool prefixed;
};

constexpr std::array kSymbols = {
    Symbol{"m", {{1, 0, 0, 0}, 0}, true},    Symbol{"g", {{0, 1, 0, 0}, -3}, true},
    Symbol{"s", {{0, 0, 1, 0}, 0}, true},    Symbol{"N", {{1, 1, -2, 0}, 0}, true},
    Symbol{"Pa", {{-1, 1, -2, 0}, 0}, true}, Symbol{"J", {{2, 1, -2, 0}, 0}, true},
    Symbol{"Hz", {{0, 0, -1, 0}, 0}, true},  Symbol{"rad", {{0, 0, 0, 1}, 0, true}, true},
    Symbol{"deg", {{0, 0, 0, 1}, 0}, false}, Symbol{"1", {}, false},
};
constexpr std::array kPrefixes = {
    std::pair{'n', -9}, std::pair{'u', -6}, std::pair{'m', -3}, std::pair{'c', -2},
    std::pair{'d', -1}, std::pair{'k', 3},  std::pair{'M', 6},  std::pair{'G', 9},
};

std::optional<Unit> symbol(const std::string& name) {
  for (const Symbol& one : kSymbols) {
    if (name == one.name) return one.unit;
  }
  for (const Symbol& one : kSymbols) {
    if (!one.prefixed || name.size() < 2 || name.substr(1) != one.name) continue;
    for (const auto& [prefix, ten] : kPrefixes) {
      if (name.front() != prefix) continue;
      Unit out = one.unit;
      out.ten += ten;
      return out;
    }
  }
  return std::nullopt;
}

// "mm2", "s^2", "kN"
std::optional<Unit> factor(std::string word, int sign) {
  int power = 1;
  if (word.size() > 1 && (word.back() == '2' || word.back() == '3')) {
    power = word.back() - '0';
    word.pop_back();
    if (word.back() == '^') word.pop_back();
  }
  std::optional<Unit> out = symbol(word);
  if (!out || (out->radians && power != 1)) return std::nullopt;
  for (int& p : out->powers) p *= sign * power;
  out->ten *= sign * power;
  return out;
}

// Factors with blanks between, at most one '/': what comes behind it divides.
std::optional<Unit> parse_unit(const std::string& text) {
  Unit out;
  std::string word;
  int sign = 1, factors = 0;
  for (const char ch : text + " ") {
    if (ch != ' ' && ch != '/') {
      word += ch;
      continue;
    }
    if (!word.empty()) {
      const std::optional<Unit> one = factor(word, sign);
      if (!one) return std::nullopt;
      for (std::size_t k = 0; k < out.powers.size(); ++k) out.powers[k] += one->powers[k];
      out.ten += one->ten;
      if (one->radians && (out.radians || sign < 0)) return std::nullopt;
      out.radians = out.radians || one->radians;
      word.clear();
      ++factors;
    }
    if (ch == '/') {
      if (sign < 0 || factors == 0) return std::nullopt;
      sign = -1;
    }
  }
  if (factors == 0) return std::nullopt;
  return out;
}

std::string kind(const Unit& unit) {
  return fmt::format("m{} kg{} s{} angle{}", unit.powers[0], unit.powers[1], unit.powers[2],
                     unit.powers[3]);
}

// The number times a power of ten, with the bits of its text in SI.
std::optional<double> times_ten(const std::string& number, int ten) {
  if (ten == 0) return dem::parse_number(number);
  const std::size_t e = number.find_first_of("eE");
  if (e != std::string::npos) {
    const auto more = dem::parse_integer(number.substr(e + 1));
    if (!more) return std::nullopt;
    // Beyond, a number is 0 or too large whatever its digits (a text has up to kMostCharacters).
    constexpr long long most = 100'000;
    ten += static_cast<int>(std::clamp(*more, -most, most));
  }
  return dem::parse_number(fmt::format("{}e{}", number.substr(0, e), ten));
}

std::string kind_of(const std::string& unit) {
  if (unit == "-") return kind({});
  const std::optional<Unit> parsed = parse_unit(unit);
  return parsed ? kind(*parsed) : "";
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
  if (!dem::parse_number(number) || !unit) return std::nullopt;
  std::optional<double> value = times_ten(number, unit->ten);
  if (!value) return std::nullopt;
  if (unit->radians) *value *= 180 / std::numbers::pi;
  return Measure{*value, kind(*unit)};
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

std::string known_units() {
  std::string symbols, prefixes;
  for (const Symbol& one : kSymbols) {
    if (std::string_view(one.name) != "1") symbols += std::string(" ") + one.name;
  }
  for (const auto& [prefix, ten] : kPrefixes) prefixes += std::string(" ") + prefix;
  return fmt::format("{}, with{} before; a blank before both, as in \"3.6 mm\"", symbols.substr(1),
                     prefixes);
}

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
