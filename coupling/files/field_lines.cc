#include "coupling/files/field_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "coupling/heap/field_rows.h"
#include "coupling/heap/heap_field.h"
#include "dem/snapshot/limits.h"

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

// Place of a component among the models' stresses; of rings r and t stand for x and y.
int component_of(std::string component, bool space) {
  for (std::size_t k = component.size() - 2; k < component.size(); ++k) {
    if (component[k] == 'r') component[k] = 'x';
    if (component[k] == 't') component[k] = 'y';
  }
  if (component == "sigma_zx") component = "sigma_xz";
  const auto& names = space ? kSpaceStress : kPlaneStress;
  return static_cast<int>(std::find(names.begin(), names.end(), component) - names.begin());
}

// Forces on the base are smeared along it alone; cells that measured lie flat wherever they are, as
// fits have them (Smoothing::marginal).
bool is_flat(const SceneField& scene, bool whole) {
  return scene.field.is_measured() || (whole && scene.name.compare(0, 4, "base") == 0);
}

bool in_space(const SceneField& scene) { return scene.field.points.cols() == 3; }

// The stress one looks at first.
std::string vertical(const SceneField& scene) { return in_space(scene) ? "sigma_zz" : "sigma_yy"; }

// Names and keys of a line: fields that are one line have their own.
void name_line(const SceneField& scene, const std::string& component, bool whole, double share,
               Profile& profile) {
  const bool usual = component == vertical(scene);
  const std::string prefix = usual ? "" : component + " ";
  const std::string key = usual ? "" : component + "_";
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
  const std::string axes = component.substr(component.size() - 2);
  const double sign = axes[0] == axes[1] ? -1 : 1;
  FieldLine out;
  out.sign = sign;
  out.component = component_of(component, in_space(scene));
  out.kernel = scene.kernel;
  out.flat = is_flat(scene, whole);
  const auto n = static_cast<Eigen::Index>(row.at.size());
  out.points.resize(n, scene.field.points.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    out.points.row(k) = scene.field.points.row(row.at[static_cast<std::size_t>(k)]);
  }
  Profile& p = out.profile;
  name_line(scene, component, whole, share, p);
  p.depth = -row.y;
  p.quantity = (sign < 0 ? "-" : "") + component;
  if (in_space(scene)) p.unit = "Pa";
  p.x = out.points.col(0);
  p.mean = sign * picked(column.value, row.at);
  if (column.error.size() == column.value.size()) p.error = picked(column.error, row.at);
  if (column.samples.rows() == column.value.size()) {
    p.samples.resize(n, column.samples.cols());
    for (Eigen::Index k = 0; k < n; ++k) {
      p.samples.row(k) = sign * column.samples.row(row.at[static_cast<std::size_t>(k)]);
    }
  }
  // Cells have measured each by itself, as fits have it.
  p.independent_length = scene.field.is_measured() ? 0 : scene.kernel->independent_length();
  return out;
}

// Rings as points of the half plane y = 0: their fields are those there.
void lay_out_rings(Field& field) {
  Eigen::MatrixXd points(field.points.rows(), 3);
  points.col(0) = field.points.col(0);
  points.col(1).setZero();
  points.col(2) = field.points.col(1);
  field.points = points;
}

// Rows along x by height: in space those points of each height that are nearest to y = 0.
std::vector<FieldRow> rows_of(const SceneField& scene, double same) {
  const Eigen::MatrixXd& points = scene.field.points;
  if (points.cols() == 2) return horizontal_rows(points, same);
  Eigen::MatrixXd flat(points.rows(), 2);
  flat << points.col(0), points.col(2);
  std::vector<FieldRow> rows = horizontal_rows(flat, same);
  for (FieldRow& row : rows) {
    double nearest = std::fabs(points(row.at.front(), 1));
    for (const Eigen::Index k : row.at) nearest = std::min(nearest, std::fabs(points(k, 1)));
    double side = 0;  // of two rows as near as each other, that of the first point
    std::erase_if(row.at, [&](Eigen::Index k) {
      const double y = points(k, 1);
      if (std::fabs(y) > nearest + same) return true;
      if (side == 0 && std::fabs(y) > same) side = y;
      return side * y < 0;
    });
  }
  return rows;
}

}  // namespace

SceneField scene_field(Field field, const std::string& name, const LineOptions& options,
                       const std::string& where) {
  SceneField out;
  const auto frame_of_field = field.attributes.find("frame");
  out.rings = frame_of_field != field.attributes.end() &&
              frame_of_field->second.find("rings") != std::string::npos;
  if (out.rings) lay_out_rings(field);
  const int dim = static_cast<int>(field.points.cols());
  out.facts.dim = dim;
  out.name = name;
  const bool coarse = field_attribute(field, "method", where) == "coarse_graining";
  const std::string kernel = coarse ? field_attribute(field, "kernel", where) : "heaviside";
  const double width = field_number(field, "width", where);
  out.kernel = make_kernel(kernel, width, dim);
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
    // A rounded cone's flanks meet above its highest point.
    if (field.attributes.count("apex_height") > 0) {
      out.apex = field_number(field, "apex_height", where) - out.facts.height;
    }
    out.facts.numbers = {{"rho_g", out.unit / out.facts.height},
                         {"phi_deg", (left + right) / 2},
                         {"left_deg", left},
                         {"right_deg", right}};
  } else {
    out.facts.height = field_number(field, "h", where);
    const bool loaded = field.attributes.count("F") > 0;
    out.scene = loaded ? Scene::response : Scene::layer;
    out.facts.force = loaded ? field_number(field, "F", where) : std::nan("");
    out.unit = loaded ? out.facts.force / std::pow(out.facts.height, dim - 1) : 1;
    const auto frame = field.attributes.find("frame");
    if (frame != field.attributes.end() && frame->second.compare(0, 7, "packing") == 0 &&
        options.origin.empty()) {
      refuse_field(
          where,
          "is in the packing's own axes, where models do not know their origin; give --origin "
          "X,Y (heaps: the apex; layers: the load), or average with --frame heap or layer");
    }
  }
  if (!options.origin.empty()) {
    if (static_cast<int>(options.origin.size()) != dim)
      refuse_field(where, fmt::format("--origin: found {} numbers, the field has {} coordinates",
                                      options.origin.size(), dim));
    for (const double number : options.origin) {
      if (!(std::abs(number) <= dem::kMostNumber))
        refuse_field(where, fmt::format("--origin: found {}, allowed: {:g} m at most, either way",
                                        number, dem::kMostNumber));
    }
    field.points.rowwise() -= Eigen::Map<const Eigen::RowVectorXd>(options.origin.data(), dim);
  }
  out.field = std::move(field);
  return out;
}

std::vector<FieldLine> lines_of(const SceneField& scene, const LineOptions& options,
                                const std::string& where) {
  const double h = scene.facts.height;
  const std::vector<FieldRow> rows = rows_of(scene, kSameRow * h);
  const std::vector<std::string> components =
      options.components.empty() ? std::vector<std::string>{vertical(scene)} : options.components;
  for (const std::string& component : components) {
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
      if (share >= 0 && share <= 1) continue;
      throw std::invalid_argument(fmt::format(
          "--heights: found {:g}, allowed: 0 (the base) to 1, shares of the height", share));
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
  for (const std::string& component : components) {
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
