// Numbers with units in case files: radius = "3.6 mm", young = "10 MPa", stored SI.
#pragma once
#include <optional>
#include <string>

#include "coupling/case/apply.h"

namespace grainfield::coupling {

/// A text that is a number with a unit behind it.
struct Measure {
  double value = 0;  ///< in SI, angles in degrees as the keys have them
  std::string kind;  ///< "m kg-1 s2": what it is made of; equal for units of one kind
};

/// "3.6 mm", "10 kN/m", "2.5 g/cm3", "0.2 rad": prefixes n u m c d k M G before m, g, s, N, Pa, J,
/// Hz, rad; deg; powers as m2 or m^2; products with blanks, and one /. The value has the bits of
/// the number written in SI (0.0036), but for rad. Nothing for any other text.
std::optional<Measure> parse_measure(const std::string& text);

/// A number with a decimal comma as it is to be written: 0.5 for "0,5", "3.6 mm" with its quotes
/// for "3,6 mm", 1.000 or 1000 for "1,000"; empty for any other text.
std::string with_point(std::string text);

/// The kinds of a key's unit: "kg/m2 (3D: kg/m3)" has one for the plane and one for space; other
/// remarks in brackets do not count.
struct UnitKinds {
  std::string plane, space;
};
UnitKinds kinds_of(const std::string& unit);

/// The value of a text with a unit, for this key. Throws std::invalid_argument, as reject(), for a
/// unit of another kind; nothing for a text that is none.
std::optional<double> measured(const Key& key, const Assignment& a, const std::string& text);

/// The units that parse_measure knows, for messages.
std::string known_units();

/// Throws likewise for units of space in a case of the plane, and the other way round.
void check_units(const Draft& draft);

}  // namespace grainfield::coupling
