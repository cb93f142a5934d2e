#include "coupling/tasks/strain_task.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "coupling/averaging/layer.h"
#include "coupling/averaging/upright.h"
#include "coupling/store/added_forces.h"
#include "coupling/tasks/placement.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

constexpr double kWidth = 3;  // mean diameters: a circle of some thirty grains
// Points of a grid where none is asked for, in the plane and in space.
constexpr int kStrainColumns = 81, kStrainRows = 31, kStrainSide = 21;

}  // namespace

void settle(StrainRequest& request, bool support_chosen, bool width_chosen) {
  if (width_chosen && !(request.options.width > 0)) {
    throw std::invalid_argument(
        fmt::format("--width: found {:g}, allowed: above 0", request.options.width));
  }
  if (request.options.measure == "kernel" && !support_chosen) request.options.support = "lucy";
}

StrainOutcome run_strain(const StrainRequest& request) {
  require_frame(request.frame);
  auto held_before = snapshot_of(request.before), held_after = snapshot_of(request.after);
  if (request.frame != "packing") {
    const dem::Vec3 up = up_of(*held_before, request.up);
    if (!up.isZero()) {
      held_before = upright(held_before, up);
      held_after = upright(held_after, up);
    }
  }
  const dem::Snapshot &before = *held_before, &after = *held_after;
  StrainOptions options = request.options;
  if (options.width == 0) options.width = kWidth * mean_diameter(before);
  const std::int64_t loaded = before.loaded_grain >= 0 ? before.loaded_grain : after.loaded_grain;
  const Placement placed = place(before, request.frame, loaded);
  const bool grid = request.points.size() == 0;
  int nx = request.nx, ny = request.ny, nz = request.nz;
  if (grid && nx > 0 && (before.dim == 3) != (nz > 0))
    throw std::invalid_argument(fmt::format(
        "--grid: found {} x {}{}, allowed: COLUMNSxROWS{}, the snapshot is {}D", nx, ny,
        nz > 0 ? fmt::format(" x {}", nz) : "", before.dim == 3 ? "xLAYERS" : "", before.dim));
  if (nx == 0) {
    nx = before.dim == 2 ? kStrainColumns : kStrainSide;
    ny = before.dim == 2 ? kStrainRows : kStrainSide;
    nz = before.dim == 2 ? 0 : kStrainSide;
  }
  const auto on_grid = [&] {
    const Span span =
        span_of(before, request.frame, {placed.left, placed.right, 0, 0, placed.front, placed.back},
                placed.depth);
    return before.dim == 2 ? span.grid(nx, ny) : span.grid(nx, ny, nz);
  };
  const Eigen::MatrixXd points = grid ? on_grid() : request.points;
  StrainResult found = strain(before, after, placed.to_packing(points), options);
  StrainOutcome out;
  out.report = found.report();  // names places in the packing, with its height upright
  out.images = found.images;
  out.doubt = found.doubt;
  out.field = std::move(found.field);
  out.field.points = points;
  out.field.nx = grid ? nx : 0;
  out.field.ny = grid ? ny : 0;
  out.field.nz = grid ? nz : 0;
  out.field.attributes["measure"] = options.measure;
  out.field.attributes["support"] = options.support;
  out.field.attributes["width"] = options.width;
  out.field.attributes["h"] = placed.depth;
  out.field.attributes["frame"] = request.frame;
  copy_added_forces(after,
                    out.field.attributes);  // of the later state, which names former ones, too
  copy_added_forces(before, out.field.attributes);
  return out;
}

}  // namespace grainfield::coupling
