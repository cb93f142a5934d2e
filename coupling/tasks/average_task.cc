#include "coupling/tasks/average_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "coupling/averaging/base.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/extent.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/rings.h"
#include "coupling/result/text_table.h"
#include "coupling/specimen/heap_field.h"
#include "coupling/tasks/average_items.h"
#include "coupling/tasks/placement.h"

namespace grainfield::coupling {
namespace {

// Points of a grid where none is asked for, in the plane and in space.
constexpr int kColumns = 81, kRows = 31, kSide = 31, kLayers = 21;

// Where the rings' axis is, in the frame.
Eigen::Vector2d axis_of(const AverageRequest& request, const AveragedExtents& all) {
  if (!request.axis.empty()) return {request.axis[0], request.axis[1]};
  if (request.frame != "packing") return {0, 0};
  return {(all.left + all.right) / 2, (all.front + all.back) / 2};
}

// Points in the request's frame, with the shape of their grid where they have one.
Field points_of(const AverageRequest& request, const AveragedExtents& all,
                const dem::Snapshot& first) {
  Field out;
  out.points = request.points;
  if (request.points.size() != 0) return out;
  const Span span =
      span_of(first, request.frame, {all.left, all.right, 0, 0, all.front, all.back}, all.depth);
  std::vector<double> heights;
  for (const double share : request.cuts)
    heights.push_back(span.bottom + share * (span.top - span.bottom));
  if (request.rings) {
    const Eigen::Vector2d axis = axis_of(request, all);
    const double radius = std::min(
        {axis.x() - all.left, all.right - axis.x(), axis.y() - all.front, all.back - axis.y()});
    if (!(radius > 0))
      throw std::invalid_argument(
          fmt::format("--axis: ({:g}, {:g}) is outside the packing, {:g} to {:g} by {:g} to {:g}",
                      axis.x(), axis.y(), all.left, all.right, all.front, all.back));
    out.points = heights.empty()
                     ? grid_points(0, radius, request.nx, span.bottom, span.top, request.ny)
                     : cut_points(0, radius, request.nx, heights);
  } else if (all.dim == 3) {
    out.points = heights.empty() ? span.grid(request.nx, request.ny, request.nz)
                                 : cut_points({all.left, all.front}, {all.right, all.back},
                                              request.nx, request.ny, heights);
    out.nz = heights.empty() ? request.nz : static_cast<int>(heights.size());
  } else {
    out.points = heights.empty() ? span.grid(request.nx, request.ny)
                                 : cut_points(all.left, all.right, request.nx, heights);
  }
  if (heights.empty() || out.nz > 0) {
    out.nx = request.nx;
    out.ny = request.ny;
  }
  return out;
}

// Rings of the frame as rings of the packing.
Eigen::MatrixXd rings_in_packing(const Eigen::MatrixXd& rings, const Eigen::Vector2d& axis,
                                 const Placement& placed) {
  const auto places = [&](double share) {
    Eigen::MatrixXd at(rings.rows(), 3);
    at.col(0) = axis.x() + share * rings.col(0).array();
    at.col(1).setConstant(axis.y());
    at.col(2) = rings.col(1);
    return placed.to_packing(at);
  };
  const Eigen::MatrixXd on_ring = places(1);
  Eigen::MatrixXd out(rings.rows(), 2);
  out.col(0) = on_ring.col(0) - places(0).col(0);
  out.col(1) = on_ring.col(2);
  return out;
}

// The field of one item on the frame's points.
Field field_of(const AveragedItem& item, const AverageRequest& request,
               const Eigen::MatrixXd& points, const Eigen::Vector2d& axis, Gaps* gaps) {
  const auto held = packing_in_frame(item.state, item, request);
  const dem::Snapshot& state = *held;
  const Placement placed = place(state, request.frame);
  const auto before = request.response ? packing_in_frame(item.unloaded, item, request) : held;
  const dem::Snapshot& unloaded = *before;
  if (!request.rings) {
    const Eigen::MatrixXd there = placed.to_packing(points);
    return request.response ? response(unloaded, state, there, request.options, gaps)
                            : average(state, there, request.options, gaps);
  }
  const Eigen::MatrixXd centre =
      placed.to_packing(Eigen::MatrixXd(Eigen::RowVector3d(axis.x(), axis.y(), 0)));
  return average_on_rings(
      [&](const Eigen::MatrixXd& places, const AverageOptions& options) {
        return request.response ? response(unloaded, state, places, options)
                                : average(state, places, options);
      },
      {centre(0, 0), centre(0, 1)}, rings_in_packing(points, axis, placed), request.options, gaps);
}

// What the request asks for is there in this dimension.
void require_dimension(const AverageRequest& request, int dim) {
  if (request.rings && dim == 2)
    throw std::invalid_argument(
        "the snapshot is 2D; averages over rings need a 3D one; leave --rings out");
  if (!request.axis.empty() && request.frame != "packing")
    throw std::invalid_argument(
        fmt::format("--axis: frame {} has its own axis; it is for frame packing", request.frame));
  if (!request.axis.empty() && !request.rings)
    throw std::invalid_argument("--axis: it is that of --rings; give both");
  if (request.points.size() != 0) return;
  const bool flat = dim == 2 || request.rings || !request.cuts.empty();
  if (request.nx > 0 && flat != (request.nz == 0))
    throw std::invalid_argument(
        fmt::format("--grid: found {} x {}{}, allowed: {}", request.nx, request.ny,
                    request.nz > 0 ? fmt::format(" x {}", request.nz) : "",
                    dim == 2                ? "COLUMNSxROWS, the snapshot is 2D"
                    : request.rings         ? "RADIIxHEIGHTS of rings"
                    : !request.cuts.empty() ? "COLUMNSxROWS of horizontal cuts"
                                            : "COLUMNSxROWSxLAYERS, the snapshot is 3D"));
}

}  // namespace

void settle(AverageRequest& request, bool kernel_chosen, bool width_chosen) {
  if (request.options.method != "coarse_graining" && !kernel_chosen) {
    request.options.kernel = "circle";
  }
  if (width_chosen && !(request.options.width > 0)) {
    throw std::invalid_argument(
        fmt::format("--width: found {:g}, allowed: above 0", request.options.width));
  }
  for (const double share : request.cuts) {
    if (!(share >= 0 && share <= 1))
      throw std::invalid_argument(
          fmt::format("--cuts: found {:g}, allowed: 0 (floor) to 1 (surface)", share));
  }
}

NamedFields run_average(AverageRequest request, Gaps* gaps, std::vector<std::string>* warnings) {
  std::vector<AveragedItem> items = averaged_items(request);
  if (items.empty())
    throw std::invalid_argument("no snapshot to average, expected FILE.h5 or FILE.h5:GROUP");
  require_frame(request.frame);
  std::vector<std::string> found;
  const AveragedExtents all = measure_items(items, request, found);
  if (warnings != nullptr) *warnings = found;
  AverageOptions& options = request.options;
  if (options.width == 0) {
    options.width = (options.method == "coarse_graining" ? 1.0 : 2.5) * all.diameter;
  }
  require_dimension(request, all.dim);
  if (request.nx == 0) {
    const bool box = all.dim == 3 && !request.rings;
    request.nx = box ? kSide : kColumns;
    request.ny = box ? kSide : kRows;
    request.nz = box && request.cuts.empty() ? kLayers : 0;
  }
  const Field where =
      points_of(request, all, *packing_in_frame(items.front().state, items.front(), request));
  const Eigen::MatrixXd& points = where.points;
  const Eigen::Vector2d axis = request.rings ? axis_of(request, all) : Eigen::Vector2d(0, 0);
  const bool base = request.response && options.method == "coarse_graining" && all.dim == 2 &&
                    request.frame == "layer" &&
                    has_base(*packing_in_frame(items.front().state, items.front(), request));
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(request.nx, all.left, all.right);
  const auto finish = [&](Field field) {
    say_averaging(options, field);
    field.attributes["h"] = all.depth;
    if (!all.heaps.empty()) say_heaps(all.heaps, field);
    if (all.load > 0) field.attributes["F"] = all.load;
    field.attributes["frame"] = request.frame;
    if (request.rings) field.attributes["rings"] = 1.0;
    field.attributes.insert(all.added_forces.begin(), all.added_forces.end());
    return field;
  };

  Ensemble fields, base_fields;
  for (const auto& item : items) {
    Field field = field_of(item, request, points, axis, gaps);
    field.points = points;
    field.nx = where.nx;
    field.ny = where.ny;
    field.nz = where.nz;
    fields.add(field);
    if (base) {
      const auto state = packing_in_frame(item.state, item, request);
      Field line = base_response(*packing_in_frame(item.unloaded, item, request), *state,
                                 x.array() + layer_frame(*state).load_x,
                                 *make_kernel(options.kernel, options.width));
      line.points.resize(x.size(), 2);
      line.points << x, Eigen::VectorXd::Constant(x.size(), -all.depth);
      base_fields.add(line);
    }
  }
  NamedFields out;
  out.emplace_back(request.response ? "response" : "average", finish(fields.with_samples()));
  if (base) out.emplace_back("base_response", finish(base_fields.with_samples()));
  return out;
}

std::string balance_markdown(const std::vector<BalanceRow>& rows) {
  const auto rms = [](const BalanceResidual& r) {
    return r.points > 0 ? fmt::format("{:.2g}", r.rms) : std::string("none");
  };
  std::vector<std::vector<std::string>> cells;
  for (const BalanceRow& row : rows) {
    cells.push_back({row.method, row.kernel, fmt::format("{:.4g}", row.width), rms(row.base),
                     rms(row.inside), rms(row.surface),
                     fmt::format("{:+.2g} %", 100 * row.worst_cut),
                     fmt::format("{:+.2g} %", 100 * row.worst_sharp)});
  }
  return markdown_table({"method", "weight", "width (m)", "rms near the floor", "rms inside",
                         "rms near the surface", "worst cut", "worst cut, sharp"},
                        cells);
}

}  // namespace grainfield::coupling
