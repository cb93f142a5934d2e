#include "coupling/store/field_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "coupling/base/unknown_name.h"
#include "coupling/base/version.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/field_attributes.h"
#include "dem/hdf5/file.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {
namespace {

namespace h5 = dem::hdf5;
constexpr std::size_t kMostListed = 30;  // names in a message
constexpr const char* format_version = "2";

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void check_name(const std::string& name) {
  const bool good = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.';
  });
  if (!good || name == "." || name == "..")
    throw std::invalid_argument(fmt::format(
        "\"{}\" cannot name a field or column; allowed are letters, digits, \"_\", \"-\", \".\"",
        h5::shown(name)));
}

void check(const NamedFields& fields) {
  for (const auto& [name, field] : fields) {
    check_name(name);
    for (const auto& [key, value] : field.attributes)
      if (std::holds_alternative<std::vector<double>>(value)) check_name(key);
    const auto n = field.points.rows();
    // As numbers that do not overflow: three integers of a file may.
    const double places = static_cast<double>(field.nx) * field.ny * std::max(field.nz, 1);
    if ((field.nx || field.ny || field.nz) && places != static_cast<double>(n))
      throw std::invalid_argument(
          fmt::format("field \"{}\": a grid of {} x {}{} with {} points", name, field.nx, field.ny,
                      field.nz > 0 ? fmt::format(" x {}", field.nz) : "", n));
    for (const Column& column : field.columns) {
      check_name(column.name);
      if (column.samples.size() != 0 &&
          (column.samples.rows() != n || column.samples.cols() != field.realizations))
        throw std::invalid_argument(
            fmt::format("field \"{}\": column \"{}\" has {} x {} single values for {} points and "
                        "{} realizations",
                        name, column.name, column.samples.rows(), column.samples.cols(), n,
                        field.realizations));
      if (column.value.size() != n || (column.error.size() != 0 && column.error.size() != n))
        throw std::invalid_argument(
            fmt::format("field \"{}\": column \"{}\" has {} values and {} errors for {} points",
                        name, column.name, column.value.size(), column.error.size(), n));
    }
  }
}

// The numbers of a file that others may have written.
void check_numbers(const Field& field, const std::string& where) {
  const auto refuse = [&](const std::string& what, double value, const char* allowed) {
    throw std::invalid_argument(
        fmt::format("{}: {}: found {:g}, allowed: {}", where, what, value, allowed));
  };
  for (const double x : field.points.reshaped()) {
    if (!(std::abs(x) <= dem::kMostNumber)) refuse("points", x, "up to 1e100 in size");
  }
  for (const Column& column : field.columns) {
    for (const double v : column.value) {
      if (std::abs(v) > dem::kMostNumber)
        refuse("value/" + column.name, v, "up to 1e100 in size, or nan");
    }
    for (const double v : column.samples.reshaped()) {
      if (std::abs(v) > dem::kMostNumber)
        refuse("samples/" + column.name, v, "up to 1e100 in size, or nan");
    }
    for (const double e : column.error) {
      if (e < 0 || e > dem::kMostNumber) refuse("error/" + column.name, e, "0 to 1e100, or nan");
    }
  }
}

std::vector<double> to_vector(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

Eigen::VectorXd to_eigen(const std::vector<double>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
}

void write_one(hid_t root, const std::string& name, const Field& field) {
  const h5::Handle group = h5::create_group(root, name);
  const int dim = static_cast<int>(field.points.cols());
  std::vector<double> points;
  for (Eigen::Index p = 0; p < field.points.rows(); ++p)
    for (int d = 0; d < dim; ++d) points.push_back(field.points(p, d));
  h5::write(group, "points", points, dim, field.is_over_height() ? "h" : "m");
  h5::write_attribute(group, "kind", "field");
  h5::write_attribute(group, "dim", dim);
  h5::write_attribute(group, "nx", field.nx);
  h5::write_attribute(group, "ny", field.ny);
  if (field.nz > 0) h5::write_attribute(group, "nz", field.nz);
  h5::write_attribute(group, "realizations", field.realizations);
  write_attributes(group, field);
  std::vector<std::string> names;
  const h5::Handle values = h5::create_group(group, "value");
  const h5::Handle errors = h5::create_group(group, "error");
  for (const Column& column : field.columns) {
    names.push_back(column.name);
    h5::write(values, column.name, to_vector(column.value), 1, column.unit);
    if (column.error.size())
      h5::write(errors, column.name, to_vector(column.error), 1, column.unit);
  }
  if (std::any_of(field.columns.begin(), field.columns.end(),
                  [](const Column& column) { return column.samples.size() != 0; })) {
    const h5::Handle samples = h5::create_group(group, "samples");
    for (const Column& column : field.columns)
      if (column.samples.size() != 0) {
        const RowMajor rows = column.samples;
        h5::write(samples, column.name, std::vector<double>(rows.data(), rows.data() + rows.size()),
                  static_cast<int>(rows.cols()), column.unit);
      }
  }
  h5::write_attribute(group, "columns", fmt::format("{}", fmt::join(names, ",")));
}

bool is_field(hid_t root, const std::string& name) {
  return h5::attribute_is(h5::open_group(root, name), "kind", "field");
}

std::vector<std::string> fields_of(hid_t root) {
  std::vector<std::string> names;
  for (const std::string& name : h5::groups(root))
    if (is_field(root, name)) names.push_back(name);
  return names;
}

// In [least, the largest int].
int number_of(hid_t group, const std::string& name, int least, const std::string& where) {
  const long long value = h5::read_integer_attribute(group, name);
  if (value < least || value > std::numeric_limits<int>::max())
    throw std::invalid_argument(fmt::format("{}: attribute \"{}\" is {}; allowed are {} and above",
                                            where, name, value, least));
  return static_cast<int>(value);
}

std::string unit_of(hid_t group, const std::string& dataset) {
  const h5::Handle data(H5Dopen2(group, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  return data.valid() && h5::has_attribute(data, "unit") ? h5::read_text_attribute(data, "unit")
                                                         : "";
}

}  // namespace

void write_fields(const std::string& file, const NamedFields& fields) {
  check(fields);
  AtomicFile target(file);
  target.write_with([&](const std::string& temporary) {
    h5::Handle out = h5::open_for_adding(temporary);
    h5::write_attribute(out, "program", "grainfield");
    h5::write_attribute(out, "version", version_and_commit());
    h5::write_attribute(out, "field_format", format_version);
    for (const auto& [name, field] : fields) write_one(out, name, field);
    h5::finish(std::move(out), file);
  });
  const std::filesystem::path path(file);
  std::filesystem::path description = path;
  description.replace_extension(".xdmf");
  AtomicFile described(description.string());
  described.write(xdmf(path.filename().string(), fields));
  const HeldSignals held;
  target.commit();
  described.commit();
}

Field read_field(const std::string& file, const std::string& name) {
  const h5::Handle in = h5::open_for_reading(file);
  const std::vector<std::string> known = fields_of(in);
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    std::vector<std::string> listed;
    for (std::size_t k = 0; k < std::min(known.size(), kMostListed); ++k)
      listed.push_back(h5::shown(known[k]));
    throw std::invalid_argument(file + ": " + unknown_name("field", h5::shown(name), listed));
  }
  const std::string where = file + ":/" + name;
  const h5::Handle group = h5::open_group(in, name);
  Field field;
  const int dim = number_of(group, "dim", 0, where);
  if (dim != 2 && dim != 3)
    throw std::invalid_argument(fmt::format("{}: dim is {}; allowed are 2 and 3", where, dim));
  const std::vector<double> points = h5::read_doubles(group, "points", dim, where);
  field.points = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      points.data(), static_cast<Eigen::Index>(points.size()) / dim, dim);
  field.nx = number_of(group, "nx", 0, where);
  field.ny = number_of(group, "ny", 0, where);
  if (h5::has_attribute(group, "nz")) field.nz = number_of(group, "nz", 0, where);
  field.realizations = number_of(group, "realizations", 1, where);
  field.attributes = read_attributes(group, where);
  const h5::Handle values = h5::open_group(group, "value");
  const h5::Handle errors = h5::open_group(group, "error");
  std::istringstream names(h5::read_text_attribute(group, "columns"));
  for (std::string column_name; std::getline(names, column_name, ',');) {
    if (field.find(column_name) != nullptr)
      throw std::invalid_argument(
          fmt::format("{}: column \"{}\" is named twice", where, h5::shown(column_name)));
    Column& column = field.add(column_name, unit_of(values, column_name));
    column.value = to_eigen(h5::read_doubles(values, column_name, 1, where + "/value"));
    if (h5::has_link(errors, column_name))
      column.error = to_eigen(h5::read_doubles(errors, column_name, 1, where + "/error"));
  }
  if (h5::has_link(group, "samples")) {
    const h5::Handle samples = h5::open_group(group, "samples");
    for (Column& column : field.columns) {
      if (!h5::has_link(samples, column.name)) continue;
      const std::vector<double> all =
          h5::read_doubles(samples, column.name, field.realizations, where + "/samples");
      column.samples = Eigen::Map<const RowMajor>(
          all.data(), static_cast<Eigen::Index>(all.size()) / field.realizations,
          field.realizations);
    }
  }
  try {
    check({{name, field}});
  } catch (const std::invalid_argument& problem) {
    throw std::invalid_argument(file + ": " + problem.what());
  }
  check_numbers(field, where);
  return field;
}

std::vector<std::string> list_fields(const std::string& file) {
  const h5::Handle in = h5::open_for_reading(file);
  return fields_of(in);
}

}  // namespace grainfield::coupling
