#include "coupling/base/unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

// m, kg, s and angle, as powers; and a power of ten.
struct Powers {
  std::array<int, 4> powers{};
  int ten = 0;
  bool radians = false;
};

struct Symbol {
  const char* name;
  Powers unit;
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

std::optional<Powers> symbol(const std::string& name) {
  for (const Symbol& one : kSymbols) {
    if (name == one.name) return one.unit;
  }
  for (const Symbol& one : kSymbols) {
    if (!one.prefixed || name.size() < 2 || name.substr(1) != one.name) continue;
    for (const auto& [prefix, ten] : kPrefixes) {
      if (name.front() != prefix) continue;
      Powers out = one.unit;
      out.ten += ten;
      return out;
    }
  }
  return std::nullopt;
}

// "mm2", "s^2", "m-3", "kN"
std::optional<Powers> factor(std::string word, int sign) {
  int power = 1;
  if (word.size() > 1 && word.back() >= '1' && word.back() <= '3') {
    power = word.back() - '0';
    word.pop_back();
    if (word.size() > 1 && word.back() == '-') {
      power = -power;
      word.pop_back();
    } else if (power == 1) {
      return std::nullopt;
    }
    if (word.size() > 1 && word.back() == '^') word.pop_back();
  }
  std::optional<Powers> out = symbol(word);
  if (!out || (out->radians && power != 1)) return std::nullopt;
  for (int& p : out->powers) p *= sign * power;
  out->ten *= sign * power;
  return out;
}

// Unicode's signs, and powers as other programs write them, as ours: "µm", "kg/m³", "kg/m**3".
std::string plain(std::string text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 10> signs{{{"\u00b5", "u"},
                                                                                 {"\u03bc", "u"},
                                                                                 {"\u00b2", "2"},
                                                                                 {"\u00b3", "3"},
                                                                                 {"\u207b", "-"},
                                                                                 {"\u00b7", " "},
                                                                                 {"**", "^"},
                                                                                 // of Latin-1
                                                                                 {"\xb5", "u"},
                                                                                 {"\xb2", "2"},
                                                                                 {"\xb3", "3"}}};
  for (const auto& [theirs, ours] : signs)
    for (std::size_t at = 0; (at = text.find(theirs, at)) != std::string::npos;)
      text.replace(at, theirs.size(), ours);
  return text;
}

std::string kind(const Powers& unit) {
  return fmt::format("m{} kg{} s{} angle{}", unit.powers[0], unit.powers[1], unit.powers[2],
                     unit.powers[3]);
}

}  // namespace

std::optional<Unit> parse_unit(const std::string& text) {
  Powers out;
  std::string word;
  int sign = 1, factors = 0;
  for (const char ch : plain(text) + " ") {
    if (ch != ' ' && ch != '/') {
      word += ch;
      continue;
    }
    if (!word.empty()) {
      const std::optional<Powers> one = factor(word, sign);
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
  return Unit{kind(out), out.ten, out.radians};
}

std::optional<double> times_ten(const std::string& number, int ten) {
  if (ten == 0) return parse_number(number);
  const std::size_t e = number.find_first_of("eE");
  if (e != std::string::npos) {
    const auto more = parse_integer(number.substr(e + 1));
    if (!more) return std::nullopt;
    // Beyond, a number is 0 or too large whatever its digits (a text has up to kMostCharacters).
    constexpr long long most = 100'000;
    ten += static_cast<int>(std::clamp(*more, -most, most));
  }
  return parse_number(fmt::format("{}e{}", number.substr(0, e), ten));
}

std::optional<double> in_si(const std::string& number, const Unit& unit) {
  std::optional<double> value = times_ten(number, unit.ten);
  const bool degrees = !unit.radians && unit.kind.ends_with("angle1");
  if (value && degrees) *value *= std::numbers::pi / 180;
  return value;
}

std::optional<double> parse_length(const std::string& text) { return parse_quantity(text, {"m"}); }

std::optional<double> parse_quantity(const std::string& text,
                                     const std::vector<std::string>& units) {
  const std::size_t blank = std::min(text.find(' '), text.size());
  const std::string number = text.substr(0, blank);
  const std::optional<Unit> unit =
      parse_unit(blank < text.size() ? text.substr(blank) : units.front());
  const bool allowed = unit && std::any_of(units.begin(), units.end(), [&](const std::string& u) {
                         return parse_unit(u)->kind == unit->kind;
                       });
  if (!allowed) return std::nullopt;
  std::optional<double> value = times_ten(number, unit->ten);
  if (value && unit->radians) *value *= 180 / std::numbers::pi;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string known_symbols() {
  std::string symbols, prefixes;
  for (const Symbol& one : kSymbols) {
    if (std::string_view(one.name) != "1") symbols += std::string(" ") + one.name;
  }
  for (const auto& [prefix, ten] : kPrefixes) prefixes += std::string(" ") + prefix;
  return fmt::format("{}, with{} before", symbols.substr(1), prefixes);
}

}  // namespace grainfield::coupling
