// Numbers from texts, as they stand in files and arguments.
#pragma once
#include <locale.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace grainfield {

/// The number that the whole text is, in any locale, also "nan", "inf", a subnormal one, and 0 for
/// one too small; nothing for other text, none, or a number too large.
inline std::optional<double> parse_number(std::string_view text) {
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const char* const end = digits.data() + digits.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (stop != end || digits.empty()) return std::nullopt;
  if (error == std::errc()) return value;
  if (error != std::errc::result_out_of_range) return std::nullopt;
  static const locale_t plain = newlocale(LC_ALL_MASK, "C", nullptr);  // "," in no locale
  value = strtod_l(std::string(digits).c_str(), nullptr, plain);
  return std::fabs(value) < 1 ? std::optional(value) : std::nullopt;
}

/// The same for a whole number of 64 bits.
inline std::optional<long long> parse_integer(std::string_view text) {
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const char* const end = digits.data() + digits.size();
  long long value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (stop != end || digits.empty() || error != std::errc()) return std::nullopt;
  return value;
}

}  // namespace grainfield
