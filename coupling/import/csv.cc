// CSV with a header line of our own names (--column for others). A table with a column i is one of
// contacts, one with name and nx one of walls, any other one of grains.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "coupling/import/format.h"

namespace grainfield::coupling {
namespace {

// A header line of another separator would be one column with a long name.
void require_commas(std::string_view header, const Lines& lines) {
  const auto count = [&](char ch) { return std::count(header.begin(), header.end(), ch); };
  for (const auto& [other, name] : {std::pair{';', "semicolons"}, {'\t', "tabs"}}) {
    if (count(other) <= count(',')) continue;
    throw std::invalid_argument(
        fmt::format("{}: found columns parted by {}, expected commas (and points in decimals)",
                    lines.where(), name));
  }
}

std::vector<ForeignTable> scan(const std::string& file) {
  Lines lines(file);
  ForeignTable table;
  table.file = file;
  table.separator = ',';
  table.units_in_header = true;
  for (std::string_view line; lines.next(line);) {
    line = trimmed(line);
    if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    if (line.empty() || line.front() == '#') continue;
    require_commas(line, lines);
    std::vector<std::string_view> names;
    split(line, ',', names);
    table.columns = std::make_shared<const std::vector<std::string>>(names.begin(), names.end());
    table.header_line = lines.line();
    table.first = lines.place();
    return {table};
  }
  throw std::invalid_argument(file +
                              ": is empty, expected a header line such as id,x,y,radius,mass");
}

}  // namespace

ImportFormat csv_format() {
  ImportFormat format;
  format.name = "csv";
  format.summary = "tables of grains, contacts and walls with a header line";
  format.scan = scan;
  for (const TableKind kind : {TableKind::grains, TableKind::contacts, TableKind::walls})
    for (const OurColumn& column : our_columns(kind))
      format.columns.emplace_back(column.name, column.name);
  return format;
}

}  // namespace grainfield::coupling
