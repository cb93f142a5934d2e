#include "coupling/output/field_csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "coupling/output/atomic_file.h"

namespace grainfield::coupling {
namespace {

bool on_rings(const Field& field) {
  const auto frame = field.attributes.find("frame");
  return frame != field.attributes.end() && frame->second.find("rings") != std::string::npos;
}

bool has_error(const Field& field, const Column& column) {
  return column.error.size() > 0 &&
         (field.realizations > 1 || column.error.array().isFinite().any());
}

}  // namespace

std::string field_csv(const Field& field) {
  std::string out = field.points.cols() == 3 ? "x,y,z" : on_rings(field) ? "r,z" : "x,y";
  for (const Column& column : field.columns) {
    out += "," + column.name;
    if (has_error(field, column)) out += "," + column.name + "_error";
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
