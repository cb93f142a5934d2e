#include "coupling/output/field_csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "coupling/output/added_forces.h"
#include "coupling/output/atomic_file.h"

namespace grainfield::coupling {
namespace {

// The axes of the points for people.
std::string frame_words(const Field& field) {
  const std::string frame = field.word("frame");
  const bool space = field.points.cols() == 3;
  const std::string origin = space || field.is_of_rings() ? "(0, 0, 0)" : "(0, 0)";
  const char* up = origin.size() > 6 ? "z" : "y";
  std::string out = frame;
  if (frame == "layer") out += fmt::format(": load at {}, surface {} = 0", origin, up);
  if (frame == "heap") {
    out += fmt::format(
        ": apex at {}, {}", origin,
        field.is_over_height() ? "lengths over its height h" : fmt::format("floor {} = -h", up));
  }
  return field.is_of_rings() ? out + ", rings: radius, height" : out;
}

// A comment: the frame of the points, how the values were averaged, over how many realizations.
std::string origin_of(const Field& field) {
  if (field.word("frame").empty()) return "";
  std::string out = "# frame " + frame_words(field);
  if (field.has("method")) out += "; " + field.word("method");
  if (field.has("kernel")) out += ", kernel " + field.word("kernel");
  if (field.has("width")) out += fmt::format(", width {} m", field.number("width"));
  return fmt::format("{}; {} realization{}; stresses tension positive\n", out, field.realizations,
                     field.realizations == 1 ? "" : "s");
}

bool has_error(const Field& field, const Column& column) {
  return column.error.size() > 0 &&
         (field.realizations > 1 || column.error.array().isFinite().any());
}

}  // namespace

std::string field_csv(const Field& field) {
  // As import-field reads them: the unit in brackets behind the name.
  const std::string length = field.is_over_height() ? "h" : "m";
  std::string out = origin_of(field) + added_forces_comment(field);
  std::string names;
  for (const char axis : std::string(field.points.cols() == 3 ? "xyz"
                                     : field.is_of_rings()    ? "rz"
                                                              : "xy")) {
    names += fmt::format("{}{} ({})", names.empty() ? "" : ",", axis, length);
  }
  out += names;
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
