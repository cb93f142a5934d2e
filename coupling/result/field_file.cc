#include "coupling/result/field_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <filesystem>
#include <stdexcept>

#include "coupling/result/csv.h"
#include "coupling/store/added_forces.h"
#include "coupling/store/atomic_file.h"

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
  Csv out(Csv::kAllDigits);
  for (const char axis : std::string(field.points.cols() == 3 ? "xyz"
                                     : field.is_of_rings()    ? "rz"
                                                              : "xy")) {
    out.add(fmt::format("{} ({})", axis, length));
  }
  for (const Column& column : field.columns) {
    const bool plain = column.unit.empty() || column.unit == "1" || column.unit == "-";
    const std::string unit = plain ? "" : fmt::format(" ({})", column.unit);
    out.add(column.name + unit);
    if (has_error(field, column)) out.add(column.name + "_error" + unit);
  }
  out.end_row();
  for (Eigen::Index p = 0; p < field.points.rows(); ++p) {
    for (Eigen::Index a = 0; a < field.points.cols(); ++a) out.add(field.points(p, a));
    for (const Column& column : field.columns) {
      out.add(column.value[p]);
      if (has_error(field, column)) out.add(column.error[p]);
    }
    out.end_row();
  }
  return origin_of(field) + added_forces_comment(field) + out.text();
}

void write_field_csv(const std::string& file, const Field& field) {
  write_text_file(file, field_csv(field));
}

namespace {

std::string ending_of(const std::string& file) {
  return boost::algorithm::to_lower_copy(std::filesystem::path(file).extension().string());
}

}  // namespace

void require_ending(const std::string& option, const std::string& file,
                    const std::vector<std::string>& endings, const std::string& what) {
  const std::string ending = ending_of(file);
  if (ending.empty() || std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  throw std::invalid_argument(fmt::format("{}: found {}, whose ending is \"{}\"; allowed: {} ({})",
                                          option, file, ending, fmt::join(endings, ", "), what));
}

void require_field_ending(const std::string& option, const std::string& file) {
  require_ending(option, file, {".h5", ".hdf5", ".csv"}, "HDF5, or a table as CSV");
}

std::string write_field_file(const std::string& file, const NamedFields& fields) {
  require_field_ending("-o", file);
  if (ending_of(file) != ".csv") {
    write_fields(file, fields);
    return "";
  }
  write_field_csv(file, fields.front().second);
  if (fields.size() < 2) return "";
  std::vector<std::string> others;
  for (std::size_t k = 1; k < fields.size(); ++k) others.push_back(fields[k].first);
  return fmt::format("{} holds {}; a file .h5 would hold {}, too", file, fields.front().first,
                     fmt::join(others, ", "));
}

}  // namespace grainfield::coupling
