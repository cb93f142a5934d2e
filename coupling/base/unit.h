// Units of measurement by their symbols: "mm", "kN/m", "g/cm3".
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace grainfield::coupling {

struct Unit {
  std::string kind;      ///< "m kg-1 s2": what it is made of; equal for units of one kind
  int ten = 0;           ///< power of ten in SI: -3 of mm
  bool radians = false;  ///< of angles: rad, else degrees
};

/// Prefixes n u m c d k M G before m, g, s, N, Pa, J, Hz, rad; deg; "1"; powers as m2 or m^2;
/// products with blanks, and one '/', behind which all divides. Nothing for any other text.
std::optional<Unit> parse_unit(const std::string& text);

/// The number times a power of ten, with the bits of its text in SI: 0.0036 of "3.6" and -3.
/// Nothing for a text that is no number.
std::optional<double> times_ten(const std::string& number, int ten);

/// A number in SI, angles in rad: 0.0036 of "3.6" in mm. Nothing for a text that is no number.
std::optional<double> in_si(const std::string& number, const Unit& unit);

/// A length in m: "0.0036", or with its unit behind a blank, "3.6 mm". Nothing for any other text
/// and for what is not finite.
std::optional<double> parse_length(const std::string& text);

/// The same of any quantity: without a unit a number in SI, of angles in degrees; with one that is
/// of the kind of any of `units`.
std::optional<double> parse_quantity(const std::string& text,
                                     const std::vector<std::string>& units);

/// "m g s N Pa J Hz rad deg, with n u m c d k M G before", for messages.
std::string known_symbols();

}  // namespace grainfield::coupling
