// Rows of tables as their values.
#pragma once
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupling/import/lines.h"

namespace grainfield::coupling {

/// Parts rows of a file. The values are valid until the next row.
class RowParts {
 public:
  /// Values of `line`, the last that `lines` gave: by white space (separator ' '), or by
  /// `separator` with values in quotation marks as in RFC 4180: separators and ends of lines may
  /// stand in them, a doubled mark is one. Reads on where a quotation ends on a later line. A
  /// comment behind the last value (" # ...") is none of it.
  const std::vector<std::string_view>& of(std::string_view line, char separator, Lines& lines);
  /// The same of a line alone.
  const std::vector<std::string_view>& of(std::string_view line, char separator);

 private:
  void part_quoted(std::string_view line, char separator);

  std::vector<std::string_view> fields_;
  std::deque<std::string> texts_;  // of values with doubled marks
  std::string joined_;             // lines of a row over several
};

/// Whether it stands for an empty cell of a spreadsheet, of R or pandas: NA, None, -, #N/A, #NV.
bool is_no_value(std::string_view value);

/// A number as files write it: parse_number(), and Fortran's exponents, 1.5D-03.
std::optional<double> foreign_number(std::string_view text);
/// "1.5D-03" -> "1.5E-03"; any other text as it is.
std::string plain_exponent(std::string_view text);

/// Without a comment behind the last value, "... # first".
std::string_view without_comment(std::string_view line, char separator);

}  // namespace grainfield::coupling
