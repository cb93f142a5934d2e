// What is thrown at a mistake in what the user gave: one line that names it.
#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace grainfield {

[[noreturn]] inline void refuse(const std::string& text) { throw std::invalid_argument(text); }
/// "WHERE: WHY".
[[noreturn]] inline void refuse(const std::string& where, const std::string& why) {
  throw std::invalid_argument(where + ": " + why);
}
/// "KEY: found FOUND, allowed: ALLOWED".
[[noreturn]] inline void refuse(const std::string& key, const std::string& found,
                                const std::string& allowed) {
  throw std::invalid_argument(fmt::format("{}: found {}, allowed: {}", key, found, allowed));
}

/// The same unless it holds.
inline void require(bool holds, const std::string& where, const std::string& why) {
  if (!holds) refuse(where, why);
}
inline void require(bool holds, const std::string& key, double found, const std::string& allowed) {
  if (!holds) refuse(key, fmt::format("{:g}", found), allowed);
}

}  // namespace grainfield
