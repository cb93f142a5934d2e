// What a file's numbers are in where no column names its own unit.
#pragma once
#include <optional>
#include <string>

#include "coupling/base/unit.h"

namespace grainfield::coupling {

/// Powers of ten of its length, mass and time in SI.
struct UnitSystem {
  std::string name = "SI";
  int length = 0, mass = 0, time = 0;
  /// Lengths, velocities and volumes only: forces, masses and densities are SI (--units mm).
  bool lengths_only = false;

  bool is_si() const { return length == 0 && mass == 0 && time == 0; }
  /// Power of ten of a quantity whose SI unit is `unit` ("kg/m3"); 0 for words.
  int ten_of(const std::string& unit) const;
};

/// "mm" and other units of length (lengths alone), or a set of LAMMPS: si, cgs, micro, nano.
/// Nothing for any other text.
std::optional<UnitSystem> parse_unit_system(const std::string& text);

/// "m, cm, mm, um, nm, km, si, cgs, micro, nano", for messages.
inline constexpr const char* kUnitSystems = "m, cm, mm, um, nm, km, si, cgs, micro, nano";

}  // namespace grainfield::coupling
