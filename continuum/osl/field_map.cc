#include "continuum/osl/field_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "continuum/model.h"
#include "continuum/number_table.h"

namespace grainfield::continuum::osl {
namespace {

/// Nodes may be off their place on the grid, and the grid short of the domain, by this share of a
/// step.
constexpr double kTolerance = 1e-6;

std::string wrong_names(const std::vector<std::string>& names,
                        const std::vector<std::string>& fields) {
  bool good = names.size() >= 3 && names[0] == "x" && names[1] == "y";
  for (std::size_t i = 2; good && i < names.size(); ++i)
    good = std::find(fields.begin(), fields.end(), names[i]) != fields.end() &&
           std::find(names.begin(), names.begin() + static_cast<long>(i), names[i]) ==
               names.begin() + static_cast<long>(i);
  return good ? "" : fmt::format("allowed: x,y and one or more of {}", fmt::join(fields, ","));
}

}  // namespace

FieldMap read_field_map(const std::string& file) {
  return read_field_map(file, {"rho_g", "eta", "mu"}, false);
}

FieldMap read_field_map(const std::string& file, const std::vector<std::string>& fields,
                        bool may_lack) {
  FieldMap map;
  map.file = file;
  if (file.empty()) return map;
  const NumberTable table = read_number_table(
      file, [&](const std::vector<std::string>& names) { return wrong_names(names, fields); },
      may_lack ? 2 : std::numeric_limits<std::size_t>::max());
  const std::vector<NumberRow>& rows = table.rows;
  std::size_t nx = 0;
  while (nx < rows.size() && rows[nx].values[1] == rows[0].values[1]) ++nx;
  const std::size_t ny = nx > 0 ? rows.size() / nx : 0;
  if (nx < 2 || ny < 2 || nx * ny != rows.size())
    refuse_line(
        file, table.last_line,
        fmt::format("{} nodes with {} in the first row form no grid; allowed: 2 x 2 or more",
                    rows.size(), nx));
  map.nx = static_cast<int>(nx);
  map.ny = static_cast<int>(ny);
  map.x0 = rows[0].values[0];
  map.y0 = rows[0].values[1];
  map.dx = (rows[nx - 1].values[0] - map.x0) / static_cast<double>(nx - 1);
  map.dy = (rows.back().values[1] - map.y0) / static_cast<double>(ny - 1);
  if (!(map.dx > 0 && map.dy > 0 && std::isfinite(map.dx) && std::isfinite(map.dy)))
    refuse_line(file, rows[1].line, "x and y of the nodes must ascend, x fastest");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double x = map.x0 + static_cast<double>(k % nx) * map.dx,
                 y = map.y0 + static_cast<double>(k / nx) * map.dy;
    const auto& v = rows[k].values;
    if (std::abs(v[0] - x) > kTolerance * map.dx || std::abs(v[1] - y) > kTolerance * map.dy)
      refuse_line(
          file, rows[k].line,
          fmt::format("node ({}, {}) is not on the regular grid, which has ({:.10g}, {:.10g}) "
                      "here",
                      v[0], v[1], x, y));
  }
  for (std::size_t c = 2; c < table.names.size(); ++c) {
    Eigen::VectorXd& values = map.values[table.names[c]];
    values.resize(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k)
      values[static_cast<Eigen::Index>(k)] = rows[k].values[c];
  }
  return map;
}

std::vector<std::string> map_columns(const std::string& file) {
  if (file.empty()) return {};
  std::vector<std::string> names = table_columns(file);
  names.erase(names.begin(), names.begin() + std::min<long>(2, static_cast<long>(names.size())));
  return names;
}

double FieldMap::at(const std::string& name, double x, double y) const {
  const Eigen::VectorXd& v = values.at(name);
  const double s = std::clamp((x - x0) / dx, 0., nx - 1.),
               t = std::clamp((y - y0) / dy, 0., ny - 1.);
  const int i = std::min(static_cast<int>(s), nx - 2), j = std::min(static_cast<int>(t), ny - 2);
  const double a = s - i, b = t - j;
  const int k = i + nx * j;
  return (1 - b) * ((1 - a) * v[k] + a * v[k + 1]) + b * ((1 - a) * v[k + nx] + a * v[k + nx + 1]);
}

Field FieldMap::field(const std::string& name, double otherwise) const {
  if (values.count(name) == 0) return [otherwise](double, double) { return otherwise; };
  const auto shared = std::make_shared<FieldMap>(*this);
  return [shared, name](double x, double depth) { return shared->at(name, x, -depth); };
}

void FieldMap::require_cover(const std::string& model, double half_width, double depth) const {
  if (values.empty()) return;
  const double x1 = x0 + (nx - 1) * dx, y1 = y0 + (ny - 1) * dy;
  if (x0 > -half_width + kTolerance * dx || x1 < half_width - kTolerance * dx ||
      y0 > -depth + kTolerance * dy || y1 < -kTolerance * dy)
    throw BadParameter(fmt::format(
        "model {}: map {} covers x from {:.6g} to {:.6g} and y from {:.6g} to {:.6g}; allowed: a "
        "map that covers x from {:.6g} to {:.6g} and y from {:.6g} to 0",
        model, file, x0, x1, y0, y1, -half_width, half_width, -depth));
}

}  // namespace grainfield::continuum::osl
