// Tables of numbers that users give to models: maps and profiles.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace grainfield::continuum {

/// A line of a table.
struct NumberRow {
  int line = 0;  ///< of the file, from 1
  std::vector<double> values;
};

struct NumberTable {
  std::string file;
  int last_line = 0;
  std::vector<std::string> names;  ///< of the header
  std::vector<NumberRow> rows;     ///< as many values each as there are names
};

/// Throws BadParameter "FILE:LINE: why".
[[noreturn]] void refuse_line(const std::string& file, int line, const std::string& why);

/// CSV: comment lines (#), a header, one line a row. `header` says what is wrong with the header's
/// names, or nothing. The values from column `may_lack_from` on may be nan. Throws BadParameter for
/// what is no file, cannot be opened, or holds another header or other rows.
NumberTable read_number_table(
    const std::string& file,
    const std::function<std::string(const std::vector<std::string>&)>& header,
    std::size_t may_lack_from = static_cast<std::size_t>(-1));

/// Names in the header; none for a file that cannot be opened, which read_number_table refuses.
std::vector<std::string> table_columns(const std::string& file);

}  // namespace grainfield::continuum
