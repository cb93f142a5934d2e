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

// Lengths of a heap's frame are over its height.
bool over_height(const Field& field) {
  const auto frame = field.attributes.find("frame");
  return frame != field.attributes.end() &&
         frame->second.find("lengths over its height") != std::string::npos;
}

// A comment: the frame of the points, how the values were averaged, over how many realizations.
std::string origin_of(const Field& field) {
  const auto told = [&](const char* name) {
    const auto at = field.attributes.find(name);
    return at == field.attributes.end() ? std::string() : at->second;
  };
  if (told("frame").empty()) return "";
  // The option's word for the models' frame.
  const std::string models = "models:", frame = told("frame");
  std::string out =
      "# frame " + (frame.starts_with(models) ? "layer:" + frame.substr(models.size()) : frame);
  if (!told("method").empty()) out += "; " + told("method");
  if (!told("kernel").empty()) out += ", kernel " + told("kernel");
  if (!told("width").empty()) out += ", width " + told("width") + " m";
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
  const std::string length = over_height(field) ? "h" : "m";
  std::string out = origin_of(field);
  std::string names;
  for (const char axis : std::string(field.points.cols() == 3 ? "xyz"
                                     : on_rings(field)        ? "rz"
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
