// A TOML file as a flat list of assignments that remember where they were written.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainfield::coupling {

using Scalar = std::variant<bool, std::int64_t, double, std::string>;

struct Assignment {
  std::string path;           ///< "material.friction"; for an empty table its own path
  std::string origin;         ///< "cases/x.toml:12", "--set" or another option
  std::vector<Scalar> items;  ///< one for a single value
  bool list = false;
  bool table = false;  ///< a table without keys
  bool other = false;  ///< a date, a list of lists: nothing that a key takes
  std::string text;    ///< as written on the command line, or a description of the value

  bool from_command_line() const { return origin.starts_with("--"); }
};

/// Most bytes of a case file, values in it, parts of a dotted key, levels of lists and tables
/// within each other, and characters of a text.
inline constexpr std::size_t kMostBytes = 4'000'000, kMostValues = 200'000, kMostParts = 32,
                             kMostLevels = 32, kMostCharacters = 4096;

/// Throws std::invalid_argument "ORIGIN:LINE: ..." (without `lines`: "ORIGIN: ...") for TOML of
/// more parts, levels or values than that: a parser calls itself for every level and keeps every
/// value.
void check_nesting(std::string_view text, const std::string& origin, bool lines);

/// Assignments of a TOML file in the order of its lines. Throws std::invalid_argument, one line
/// "FILE:LINE: what", for a missing, unreadable or malformed file.
std::vector<Assignment> read_document(const std::string& file);
/// "key.path=value": the value is TOML, or else taken as a bare word. Throws std::invalid_argument.
Assignment parse_override(const std::string& text);
/// Several, in their order. Throws std::invalid_argument, "--set: KEY: ...", for a key that is
/// given twice, too.
std::vector<Assignment> parse_overrides(const std::vector<std::string>& texts);
/// A scalar as TOML text; strings without quotes.
std::string scalar_text(const Scalar& scalar);
/// "0.3 (number)", "\"abc\" (text)", "true (boolean)", "a list", for messages.
std::string describe(const Assignment& assignment);

}  // namespace grainfield::coupling
