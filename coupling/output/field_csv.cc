#include "coupling/output/field_csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "coupling/output/atomic_file.h"

namespace grainfield::coupling {
namespace {

bool has_error(const Field& field, const Column& column) {
  return column.error.size() > 0 &&
         (field.realizations > 1 || column.error.array().isFinite().any());
}

}  // namespace

std::string field_csv(const Field& field) {
  // As import-field reads them: the unit in brackets behind the name.
  const std::string length = field.is_over_height() ? "h" : "m";
  std::string out;
  for (const char axis : std::string(field.points.cols() == 3 ? "xyz"
                                     : field.is_of_rings()    ? "rz"
                                                              : "xy")) {
    out += fmt::format("{}{} ({})", out.empty() ? "" : ",", axis, length);
  }
  for (const Column& column : field.columns) {
    const bool plain = column.unit.empty() || column.unit == "1" || column.unit == "-";
    const std::string unit = plain ? "" : fmt::format(" ({})", column.unit);
    out += fmt::format(",{}{}", column.name, unit);
    if (has_error(field, column)) out += fmt::format(",{}_error{}", column.name, unit);
  }
  out += '\n';
  const auto add = [&](double value, const char* before) {
    if (std::isnan(value))
      fmt::format_to(std::back_inserter(out), "{}nan", before);
    else
      fmt::format_to(std::back_inserter(out), "{}{}", before, value);
  };
  for (Eigen::Index p = 0; p < field.points.rows(); ++p) {
    for (Eigen::Index a = 0; a < field.points.cols(); ++a)
      add(field.points(p, a), a > 0 ? "," : "");
    for (const Column& column : field.columns) {
      add(column.value[p], ",");
      if (has_error(field, column)) add(column.error[p], ",");
    }
    out += '\n';
  }
  return out;
}

void write_field_csv(const std::string& file, const Field& field) {
  write_text_file(file, field_csv(field));
}

}  // namespace grainfield::coupling
