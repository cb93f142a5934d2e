#include "coupling/statistics/value_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainfield::coupling {
namespace {

// Decimals that give an error two digits, and the power of ten that both numbers are divided by: 0
// of errors from 1e-4 to 1e4.
struct Digits {
  int decimals = 0, power = 0;
};
Digits digits_of(double value, double error) {
  const int magnitude = static_cast<int>(std::floor(std::log10(error)));
  if (magnitude >= -4 && magnitude < 4) return {std::clamp(1 - magnitude, 0, 6), 0};
  const double larger = std::max(std::fabs(value), error);
  const int power = static_cast<int>(std::floor(std::log10(larger)));
  return {std::clamp(power - magnitude + 1, 0, 6), power};
}

}  // namespace

std::string to_digits_of(double value, double error) {
  const Digits digits = digits_of(value, error);
  return digits.power == 0 ? fmt::format("{:.{}f}", value, digits.decimals)
                           : fmt::format("{:.{}e}", value, digits.decimals);
}

std::string with_error(double value, double error) {
  if (!std::isfinite(value)) return "-";
  if (!std::isfinite(error)) return fmt::format("{:.4g}", value);
  if (!(error > 0)) return fmt::format("{:.4g} ± 0", value);
  const auto [decimals, power] = digits_of(value, error);
  if (power == 0) return fmt::format("{:.{}f} ± {:.{}f}", value, decimals, error, decimals);
  const double unit = std::pow(10.0, power);
  return fmt::format("({:.{}f} ± {:.{}f})e{}", value / unit, decimals, error / unit, decimals,
                     power);
}

}  // namespace grainfield::coupling
