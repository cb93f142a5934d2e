// Fields in the models' frame and their horizontal lines.
#include "coupling/observe/field_observations.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

#include "coupling/observe/seen_models.h"
#include "coupling/run/comparison_page.h"
#include "coupling/specimen/field_rows.h"
#include "coupling/specimen/heap_field.h"
#include "dem/snapshot/limits.h"

namespace grainfield::coupling {
namespace {

constexpr double kSame = 1e-9;     // relative: loads and sizes of fields that belong together
constexpr double kSameRow = 1e-9;  // of h
constexpr double kNearRow = 0.05;  // of h: a row further from a height than this is another one
constexpr int kLeastPoints = 3;

// A field in the models' frame, in m and N/m (in space Pa).
struct FieldScene {
  Specimen specimen = Specimen::rest;
  std::string name;
  Field field;
  RunFacts told;    // force nan without a load
  double unit = 1;  // N/m
  double apex = 0;  // m, of the models' cone above the field's origin
  std::shared_ptr<const Kernel> kernel;
  bool rings = false;
};

// Forces on the base are smeared along it alone; cells that measured lie flat wherever they are, as
// fits have them (Smoothing::marginal).
bool is_flat(const FieldScene& scene, bool whole) {
  return scene.field.is_measured() || (whole && scene.name.compare(0, 4, "base") == 0);
}

bool in_space(const FieldScene& scene) { return scene.field.points.cols() == 3; }

// The stress one looks at first.
std::string vertical(const FieldScene& scene) { return in_space(scene) ? "sigma_zz" : "sigma_yy"; }

// Fields that are one line have their own name.
LineOf line_named(const FieldScene& scene, const std::string& component, bool whole, double share) {
  LineOf out{component, "", "", is_flat(scene, whole) ? Smoothing::marginal : Smoothing::kernel};
  const bool usual = component == vertical(scene);
  const std::string prefix = usual ? "" : component + " ";
  const std::string key = usual ? "" : component + "_";
  if (whole) {
    out.name = prefix + scene.name;
    out.key = key + scene.name;
  } else if (scene.specimen == Specimen::heap) {
    out.name = fmt::format("{}height {:.3g} h", prefix, share);
    out.key = fmt::format("{}height_{:.3g}", key, share);
  } else {
    out.name = fmt::format("{}{} at depth {:.3g} h", prefix, scene.name, 1 - share);
    out.key = fmt::format("{}depth_{:.3g}", key, 1 - share);
  }
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
std::vector<FieldRow> rows_of(const FieldScene& scene, double same) {
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

FieldScene scene_of(Field field, const std::string& name, const LineOptions& options,
                    const std::string& where) {
  FieldScene out;
  out.rings = field.is_of_rings();
  if (out.rings) lay_out_rings(field);
  const int dim = static_cast<int>(field.points.cols());
  out.told.dim = dim;
  out.name = name;
  out.kernel = kernel_of(field, where);
  if (field.is_of_heap()) {
    out.specimen = Specimen::heap;
    require_compression(field, where);
    field = in_mean_heap(std::move(field), where);
    const double left = field.number("left_deg"), right = field.number("right_deg");
    out.unit = field_number(field, "rho_g_h", where);
    out.told.height = out.told.depth = field_number(field, "h", where);
    out.told.force = std::nan("");
    // A rounded cone's flanks meet above its highest point.
    if (field.has("apex_height")) {
      out.apex = field_number(field, "apex_height", where) - out.told.height;
    }
    out.told.numbers = {{"rho_g", out.unit / out.told.height},
                        {"phi_deg", (left + right) / 2},
                        {"left_deg", left},
                        {"right_deg", right}};
  } else {
    out.told.height = field_number(field, "h", where);
    const bool loaded = field.has("F");
    out.specimen = loaded ? Specimen::layer : Specimen::rest;
    out.told.force = loaded ? field_number(field, "F", where) : std::nan("");
    out.unit = loaded ? out.told.force / std::pow(out.told.height, dim - 1) : 1;
    if (field.word("frame") == "packing" && options.origin.empty()) {
      refuse(where,
             "is in the packing's own axes, where models do not know their origin; give --origin "
             "X,Y (heaps: the apex; layers: the load), or average with --frame heap or layer");
    }
  }
  if (!options.origin.empty()) {
    if (static_cast<int>(options.origin.size()) != dim)
      refuse(where, fmt::format("--origin: found {} numbers, the field has {} coordinates",
                                options.origin.size(), dim));
    for (const double number : options.origin) {
      if (!(std::abs(number) <= dem::kMostNumber))
        refuse(where, fmt::format("--origin: found {}, allowed: {:g} m at most, either way", number,
                                  dem::kMostNumber));
    }
    field.points.rowwise() -= Eigen::Map<const Eigen::RowVectorXd>(options.origin.data(), dim);
  }
  out.field = std::move(field);
  return out;
}

std::vector<ObservedLine> lines_of(const FieldScene& scene, const LineOptions& options,
                                   const std::string& where) {
  const double h = scene.told.height;
  const std::vector<FieldRow> rows = rows_of(scene, kSameRow * h);
  const std::vector<std::string> components =
      options.components.empty() ? std::vector<std::string>{vertical(scene)} : options.components;
  for (const std::string& component : components) {
    if (scene.field.find(component) == nullptr) {
      refuse(where, fmt::format("has no column \"{}\"", component));
    }
  }
  if (scene.field.nx == 0 &&
      rows.size() * kLeastPoints > static_cast<std::size_t>(scene.field.points.rows())) {
    refuse(where, "its points are neither horizontal lines nor a grid");
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
      heights = scene.specimen == Specimen::heap ? std::vector<double>{0.1, 0.25, 0.4}
                                                 : std::vector<double>{0.75, 0.5, 0.25};
    }
    for (const double share : heights) {
      const FieldRow& row = nearest_row(rows, (share - 1) * h);
      if (options.heights.size() > 0 && std::fabs(row.y - (share - 1) * h) > kNearRow * h) {
        refuse(where, fmt::format("has no row at height {:g} h; its rows go from {:.3g} to {:.3g}",
                                  share, 1 + rows.front().y / h, 1 + rows.back().y / h));
      }
      chosen.push_back(&row);
    }
  }
  std::vector<ObservedLine> out;
  const bool whole = scene.field.nx == 0 && rows.size() == 1;
  for (const std::string& component : components) {
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      // Rows of the three default heights of layers keep those heights as names.
      double share = 1 + chosen[k]->y / h;
      if (scene.specimen != Specimen::heap && scene.field.nx > 0 && options.heights.empty()) {
        share = 0.75 - 0.25 * static_cast<double>(k);
      }
      ObservedLine line = observed_line(scene.field, line_named(scene, component, whole, share),
                                        scene.kernel, chosen[k]->at);
      line.profile.depth = -chosen[k]->y;
      if (line.profile.mean.array().isFinite().count() < kLeastPoints) continue;
      out.push_back(std::move(line));
    }
  }
  if (out.empty()) refuse(where, "has no line with three values or more");
  return out;
}

void require_same(const FieldScene& first, const FieldScene& next, const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(
        fmt::format("{}: fields {} and {} differ in {}; compare one of them (--field)", file,
                    first.name, next.name, what));
  };
  const auto differ = [](double a, double b) {
    return std::isfinite(a) != std::isfinite(b) || std::fabs(a - b) > kSame * std::fabs(a);
  };
  if (first.specimen != next.specimen) refuse("what they show (load, heap, layer)");
  if (differ(first.told.force, next.told.force)) {
    refuse(fmt::format("F ({:g} and {:g} N)", first.told.force, next.told.force));
  }
  if (differ(first.told.height, next.told.height)) {
    refuse(fmt::format("h ({:g} and {:g} m)", first.told.height, next.told.height));
  }
  if (first.field.realizations != next.field.realizations) {
    refuse(
        fmt::format("realizations ({} and {})", first.field.realizations, next.field.realizations));
  }
}

Scale scale_of(const FieldScene& scene) {
  const double h = scene.told.height;
  const int n = scene.field.realizations;
  if (scene.specimen == Specimen::layer) return scale_of_load(scene.told.force, h, scene.told.dim);
  if (scene.specimen == Specimen::heap)
    return scale_of_heaps(h, scene.unit, scaled_alone(n), "apex", scene.told.dim);
  return {h,        scene.unit,
          kNan,     scene.told.dim == 3 ? "Pa" : "N/m",
          "origin", fmt::format("h = {:.6g} m; realizations: {}", h, n)};
}

}  // namespace

std::shared_ptr<const Kernel> kernel_of(const Field& field, const std::string& where) {
  const bool coarse = field_word(field, "method", where) == "coarse_graining";
  return make_kernel(coarse ? field_word(field, "kernel", where) : "heaviside",
                     field_number(field, "width", where),
                     field.is_of_rings() ? 3 : static_cast<int>(field.points.cols()));
}

Observations observe_fields(const NamedFields& fields, const LineOptions& options,
                            const std::string& file) {
  Observations out;
  std::vector<FieldScene> scenes;
  std::set<std::string> kernels;
  for (const auto& [name, field] : fields) {
    const std::string where = file + ":" + name;
    const std::string averaged =
        fmt::format("{}, {}, {:g} m", field_word(field, "method", where),
                    field_word(field, "kernel", where), field_number(field, "width", where));
    kernels.insert(averaged);
    out.seen.push_back(fmt::format("{}: {}", name, averaged));
    FieldScene scene = scene_of(field, name, options, where);
    if (!scenes.empty()) require_same(scenes.front(), scene, file);
    for (ObservedLine& line : lines_of(scene, options, where)) out.lines.push_back(std::move(line));
    if (scene.field.nx > 0 && scene.told.dim == 2) out.map = scene.field;
    scenes.push_back(std::move(scene));
  }
  const FieldScene& first = scenes.front();
  out.specimen = first.specimen;
  out.measured = first.field.is_measured();
  out.realizations = first.field.realizations;
  out.scale = scale_of(first);
  out.told = first.told;
  out.apex = first.apex;
  out.told.depth = out.lines.front().profile.depth;
  for (const ObservedLine& line : out.lines) {
    out.told.depth = std::min(out.told.depth, line.profile.depth);
  }
  if (out.specimen == Specimen::heap) out.told.depth = out.told.height += out.apex;
  if (kernels.size() > 1) {
    out.note =
        fmt::format("Fields are seen through different kernels, models through each one's own: {}.",
                    fmt::join(out.seen, "; "));
  }
  return out;
}

}  // namespace grainfield::coupling
