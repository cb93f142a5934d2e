// A value and its error as text.
#pragma once
#include <string>

namespace grainfield::coupling {

/// "0.350 ± 0.021": to two digits of the error; without one four digits of the value.
std::string with_error(double value, double error);
/// The value alone to the digits that it has there. `error`: above 0.
std::string to_digits_of(double value, double error);

}  // namespace grainfield::coupling
