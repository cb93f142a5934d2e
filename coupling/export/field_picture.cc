#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "coupling/export/forms.h"

namespace grainfield::coupling {
namespace {

// More lines of points are no profiles for the eye.
constexpr std::size_t kMostLines = 8;
// Coordinates nearer than this share of the field's extent are one.
constexpr double kSame = 1e-6;

std::vector<std::string> axes_of(const Field& field) {
  if (field.points.cols() == 3) return {"x", "y", "z"};
  return field.is_of_rings() ? std::vector<std::string>{"r", "z"}
                             : std::vector<std::string>{"x", "y"};
}

// Rows of points that share all coordinates but one, along which they are sorted; by the others'
// coordinates, the lowest first.
struct Lines {
  int axis = 0;
  std::map<std::vector<double>, std::vector<Eigen::Index>> rows;
};

Lines lines_along(const Field& field, int axis) {
  Lines out;
  out.axis = axis;
  const auto& points = field.points;
  const double extent = (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
  const double step = extent > 0 ? kSame * extent : 1;
  // The coordinates of each line's first point.
  std::map<std::vector<double>, std::vector<double>> shown;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    std::vector<double> rounded, others;
    for (Eigen::Index a = points.cols() - 1; a >= 0; --a) {
      if (a == axis) continue;
      rounded.push_back(std::round(points(k, a) / step));
      others.push_back(points(k, a));
    }
    out.rows[shown.emplace(rounded, others).first->second].push_back(k);
  }
  for (auto& [others, rows] : out.rows) {
    std::sort(rows.begin(), rows.end(),
              [&](Eigen::Index a, Eigen::Index b) { return points(a, axis) < points(b, axis); });
  }
  return out;
}

// Along the axis that makes the fewest lines.
Lines lines_of(const std::string& title, const Field& field) {
  Lines best;
  for (int axis = 0; axis < field.points.cols(); ++axis) {
    Lines one = lines_along(field, axis);
    if (best.rows.empty() || one.rows.size() < best.rows.size()) best = std::move(one);
  }
  const bool long_enough = std::any_of(best.rows.begin(), best.rows.end(),
                                       [](const auto& line) { return line.second.size() > 1; });
  if (best.rows.size() > kMostLines || !long_enough) {
    throw std::invalid_argument(
        fmt::format("{}: {} points on {} lines along {}, drawn are a grid in the plane, as a map, "
                    "and up to {} lines, as profiles (--to vtu and csv take any)",
                    title, field.points.rows(), best.rows.size(),
                    axes_of(field)[static_cast<std::size_t>(best.axis)], kMostLines));
  }
  return best;
}

bool is_normal_stress(const std::string& name) {
  return name.size() == 8 && name.starts_with("sigma_") && name[6] == name[7];
}

// The name in a label, in which gnuplot takes _ for an index.
std::string shown_name(std::string name) {
  if (name.size() == 8 && name.starts_with("sigma_")) return "σ_{" + name.substr(6) + "}";
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::vector<const Column*> drawn_columns(const Field& field, const std::string& column) {
  if (!column.empty()) return {&drawn_column(field, column)};
  std::vector<const Column*> out;
  for (const std::string& name : kSpaceStress) {
    const Column* found = field.find(name);
    if (found != nullptr && found->value.array().isFinite().any()) out.push_back(found);
  }
  if (out.empty()) out.push_back(&drawn_column(field, column));
  return out;
}

Frame profile_frame(const Field& field, const Lines& lines, const Column& column) {
  const bool measured = field.is_measured(), normal = is_normal_stress(column.name);
  const std::vector<std::string> axes = axes_of(field);
  Frame frame{fmt::format("{}{} ({})", normal ? "-" : "", column.name, column.unit), {}};
  for (const auto& [others, rows] : lines.rows) {
    std::vector<Eigen::Index> there;
    for (const Eigen::Index row : rows) {
      if (std::isfinite(column.value[row])) there.push_back(row);
    }
    Series series;
    series.label = measured ? "measured" : "";
    std::size_t k = 0;
    for (int a = static_cast<int>(axes.size()) - 1; a >= 0; --a) {
      if (a == lines.axis) continue;
      series.label += fmt::format("{}{} = {:.4g}{}", series.label.empty() ? "" : ", ",
                                  axes[static_cast<std::size_t>(a)], others[k++] + 0.0,
                                  field.is_over_height() ? " h" : " m");
    }
    series.x = field.points.col(lines.axis)(there);
    series.y = (normal ? -1 : 1) * column.value(there);
    if (column.error.size() > 0) series.error = column.error(there);
    series.colour = static_cast<int>(frame.series.size());
    series.points = true;
    series.bars = true;
    frame.series.push_back(std::move(series));
  }
  return frame;
}

}  // namespace

const Column& drawn_column(const Field& field, const std::string& column) {
  const std::string vertical = field.points.cols() == 3 ? "sigma_zz" : "sigma_yy";
  if (const Column* found = field.find(column.empty() ? vertical : column)) return *found;
  if (column.empty() && !field.columns.empty()) return field.columns.front();
  std::vector<std::string> names;
  for (const Column& one : field.columns) names.push_back(one.name);
  throw std::invalid_argument(
      fmt::format("--column: found \"{}\", allowed: {}", column, fmt::join(names, ", ")));
}

Picture field_picture(const std::string& title, const Field& field, const std::string& column) {
  const std::vector<std::string> axes = axes_of(field);
  const std::string of = field.is_over_height() ? "/h" : " (m)";
  if (field.nx > 1 && field.ny > 1 && field.points.cols() == 2) {
    const Column& drawn = drawn_column(field, column);
    return maps(title, axes[0] + of, axes[1] + of,
                fmt::format("{} ({})", shown_name(drawn.name), drawn.unit),
                {{drawn.name, field.nx, field.ny, field.points, drawn.value}});
  }
  if (field.points.rows() == 0) throw std::invalid_argument(title + ": holds no points");
  const std::vector<const Column*> columns = drawn_columns(field, column);
  const Lines lines = lines_of(title, field);
  std::vector<Frame> frames;
  for (const Column* one : columns) frames.push_back(profile_frame(field, lines, *one));
  const bool bars = std::any_of(columns.begin(), columns.end(), [](const Column* one) {
    return one->error.size() > 0 && one->error.array().isFinite().any();
  });
  const std::string along = axes[static_cast<std::size_t>(lines.axis)] + of;
  return curves(title, bars ? along + "; bars: standard error" : along, "", frames);
}

}  // namespace grainfield::coupling
