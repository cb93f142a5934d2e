#include "coupling/run/field_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "coupling/run/field_rows.h"
#include "coupling/run/heap_field.h"

namespace grainfield::coupling {
namespace {

constexpr double kSameRow = 1e-9;  // of h
constexpr double kNearRow = 0.05;  // of h: a row further from a height than this is another one
constexpr int kLeastPoints = 3;

Eigen::VectorXd picked(const Eigen::VectorXd& all, const std::vector<Eigen::Index>& at) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(at.size()));
  for (std::size_t k = 0; k < at.size(); ++k) out[static_cast<Eigen::Index>(k)] = all[at[k]];
  return out;
}

bool is_base(const std::string& name) { return name.compare(0, 4, "base") == 0; }

// Names and keys of a line: fields that are one line have their own.
void name_line(const SceneField& scene, const std::string& component, bool whole, double share,
               Profile& profile) {
  const std::string prefix = component == "sigma_yy" ? "" : component + " ";
  const std::string key = component == "sigma_yy" ? "" : component + "_";
  if (whole) {
    profile.name = prefix + scene.name;
    profile.key = key + scene.name;
  } else if (scene.scene == Scene::heap) {
    profile.name = fmt::format("{}height {:.3g} h", prefix, share);
    profile.key = fmt::format("{}height_{:.3g}", key, share);
  } else {
    profile.name = fmt::format("{}{} at depth {:.3g} h", prefix, scene.name, 1 - share);
    profile.key = fmt::format("{}depth_{:.3g}", key, 1 - share);
  }
}

FieldLine line_of(const SceneField& scene, const FieldRow& row, const std::string& component,
                  bool whole, double share) {
  const Column& column = *scene.field.find(component);
  const double sign = component == "sigma_xy" ? 1 : -1;
  FieldLine out;
  out.component = static_cast<int>(std::find(kPlaneStress.begin(), kPlaneStress.end(), component) -
                                   kPlaneStress.begin());
  out.kernel = scene.kernel;
  out.base = whole && is_base(scene.name);
  const auto n = static_cast<Eigen::Index>(row.at.size());
  out.points.resize(n, 2);
  for (Eigen::Index k = 0; k < n; ++k) {
    out.points.row(k) = scene.field.points.row(row.at[static_cast<std::size_t>(k)]);
  }
  Profile& p = out.profile;
  name_line(scene, component, whole, share, p);
  p.depth = -row.y;
  p.quantity = (sign < 0 ? "-" : "") + component;
  p.x = out.points.col(0);
  p.mean = sign * picked(column.value, row.at);
  if (column.error.size() == column.value.size()) p.error = picked(column.error, row.at);
  if (column.samples.rows() == column.value.size()) {
    p.samples.resize(n, column.samples.cols());
    for (Eigen::Index k = 0; k < n; ++k) {
      p.samples.row(k) = sign * column.samples.row(row.at[static_cast<std::size_t>(k)]);
    }
  }
  p.independent_length = scene.kernel->independent_length();
  return out;
}

}  // namespace

SceneField scene_field(Field field, const std::string& name, const LineOptions& options,
                       const std::string& where) {
  if (field.points.cols() != 2) refuse_field(where, "is 3D; a field in two dimensions is needed");
  SceneField out;
  out.name = name;
  const bool coarse = field_attribute(field, "method", where) == "coarse_graining";
  const std::string kernel = coarse ? field_attribute(field, "kernel", where) : "heaviside";
  const double width = field_number(field, "width", where);
  out.kernel = make_kernel(kernel, width);
  out.seen = fmt::format("{}, {}, {:g} m", field_attribute(field, "method", where),
                         field_attribute(field, "kernel", where), width);
  if (is_heap_field(field)) {
    out.scene = Scene::heap;
    require_compression(field, where);
    field = in_mean_heap(std::move(field), where);
    const double left = field.attributes.count("left_deg") > 0
                            ? field_number(field, "left_deg", where)
                            : std::nan("");
    const double right = field.attributes.count("right_deg") > 0
                             ? field_number(field, "right_deg", where)
                             : std::nan("");
    out.unit = field_number(field, "rho_g_h", where);
    out.facts.height = out.facts.depth = field_number(field, "h", where);
    out.facts.force = std::nan("");
    out.facts.numbers = {{"rho_g", out.unit / out.facts.height},
                         {"phi_deg", (left + right) / 2},
                         {"left_deg", left},
                         {"right_deg", right}};
  } else {
    out.facts.height = field_number(field, "h", where);
    const bool loaded = field.attributes.count("F") > 0;
    out.scene = loaded ? Scene::response : Scene::layer;
    out.facts.force = loaded ? field_number(field, "F", where) : std::nan("");
    out.unit = loaded ? out.facts.force / out.facts.height : 1;
    const auto frame = field.attributes.find("frame");
    if (frame != field.attributes.end() && frame->second == "packing" && options.origin.empty()) {
      refuse_field(
          where,
          "is in the packing's own axes, where models do not know their origin; give --origin "
          "X,Y (heaps: the apex; layers: the load), or average with --frame heap or layer");
    }
  }
  if (!options.origin.empty()) {
    field.points.rowwise() -= Eigen::RowVector2d(options.origin[0], options.origin[1]);
  }
  out.field = std::move(field);
  return out;
}

std::vector<FieldLine> lines_of(const SceneField& scene, const LineOptions& options,
                                const std::string& where) {
  const double h = scene.facts.height;
  const std::vector<FieldRow> rows = horizontal_rows(scene.field.points, kSameRow * h);
  for (const std::string& component : options.components) {
    if (scene.field.find(component) == nullptr) {
      refuse_field(where, fmt::format("has no column \"{}\"", component));
    }
  }
  if (scene.field.nx == 0 &&
      rows.size() * kLeastPoints > static_cast<std::size_t>(scene.field.points.rows())) {
    refuse_field(where, "its points are neither horizontal lines nor a grid");
  }
  std::vector<const FieldRow*> chosen;
  if (scene.field.nx == 0) {
    for (const FieldRow& row : rows) chosen.push_back(&row);
  } else {
    std::vector<double> heights = options.heights;
    for (const double share : heights) {
      if (share > 0 && share <= 1) continue;
      throw std::invalid_argument(fmt::format(
          "--heights: found {:g}, allowed: above 0, up to 1, shares of the height", share));
    }
    if (heights.empty()) {
      heights = scene.scene == Scene::heap ? std::vector<double>{0.1, 0.25, 0.4}
                                           : std::vector<double>{0.75, 0.5, 0.25};
    }
    for (const double share : heights) {
      const FieldRow& row = nearest_row(rows, (share - 1) * h);
      if (options.heights.size() > 0 && std::fabs(row.y - (share - 1) * h) > kNearRow * h) {
        refuse_field(where,
                     fmt::format("has no row at height {:g} h; its rows go from {:.3g} to {:.3g}",
                                 share, 1 + rows.front().y / h, 1 + rows.back().y / h));
      }
      chosen.push_back(&row);
    }
  }
  std::vector<FieldLine> out;
  const bool whole = scene.field.nx == 0 && rows.size() == 1;
  for (const std::string& component : options.components) {
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      // Rows of the three default heights of layers keep those heights as names.
      double share = 1 + chosen[k]->y / h;
      if (scene.scene != Scene::heap && scene.field.nx > 0 && options.heights.empty()) {
        share = 0.75 - 0.25 * static_cast<double>(k);
      }
      FieldLine line = line_of(scene, *chosen[k], component, whole, share);
      if (line.profile.mean.array().isFinite().count() < kLeastPoints) continue;
      out.push_back(std::move(line));
    }
  }
  if (out.empty()) refuse_field(where, "has no line with three values or more");
  return out;
}

}  // namespace grainfield::coupling
