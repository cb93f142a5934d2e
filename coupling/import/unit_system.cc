#include "coupling/import/unit_system.h"

#include <array>
#include <charconv>
#include <utility>

namespace grainfield::coupling {
namespace {

// m, kg, s of a kind, "m1 kg1 s-2 angle0".
std::array<int, 3> powers_of(const std::string& kind) {
  std::array<int, 3> out{};
  const std::array<std::string, 3> names{"m", "kg", "s"};
  std::size_t at = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    at = kind.find(names[k], at) + names[k].size();
    std::from_chars(kind.data() + at, kind.data() + kind.size(), out[k]);
    at = kind.find(' ', at);
  }
  return out;
}

}  // namespace

int UnitSystem::ten_of(const std::string& unit) const {
  if (unit.empty() || is_si()) return 0;
  if (lengths_only && unit != "m" && unit != "m/s") return 0;
  const std::optional<Unit> parsed = parse_unit(unit);
  if (!parsed) return 0;
  const std::array<int, 3> powers = powers_of(parsed->kind);
  return powers[0] * length + powers[1] * mass + powers[2] * time;
}

std::optional<UnitSystem> parse_unit_system(const std::string& text) {
  // docs.lammps.org/units.html: mass, distance and time of each set.
  static const std::array sets{
      UnitSystem{"si", 0, 0, 0, false}, UnitSystem{"cgs", -2, -3, 0, false},
      UnitSystem{"micro", -6, -15, -6, false}, UnitSystem{"nano", -9, -21, -9, false}};
  for (const UnitSystem& set : sets)
    if (set.name == text) return set;
  // One symbol: "mm2/m" is of the kind of a length too.
  const bool single = text.find_first_of(" /^0123456789") == std::string::npos;
  const std::optional<Unit> unit = parse_unit(text);
  if (!single || !unit || unit->kind != parse_unit("m")->kind) return std::nullopt;
  return UnitSystem{text, unit->ten, 0, 0, true};
}

}  // namespace grainfield::coupling
