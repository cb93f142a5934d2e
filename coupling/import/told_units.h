// Units that a file tells in words beside its tables.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// The first word of a line that is a unit other than those of SI, "mm", "kN", "g/cm3"; "5 mm" is a
/// quantity and no such word. Empty: none.
std::string foreign_unit_in(const std::string& line);

/// Units of `count` columns, empty for "-" and "1", where a line is nothing else: "-,mm,mm", "#
/// units:
/// - mm mm". `known`: units beside those of parse_unit. Nothing for any other line.
std::optional<std::vector<std::string>> units_row(const std::string& line, char separator,
                                                  std::size_t count,
                                                  const std::vector<std::string>& known = {});

/// "x" and "mm" -> "x (mm)", for each of the names.
std::vector<std::string> names_with_units(std::vector<std::string> names,
                                          const std::vector<std::string>& units);

/// "FILE:LINE: found "lengths in mm"" where the line has such a word; "" where not.
std::string unit_remark(const std::string& file, long long line, const std::string& text);

}  // namespace grainfield::coupling
