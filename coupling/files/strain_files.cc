#include "coupling/files/strain_files.h"

#include <fmt/format.h>

#include <utility>

#include "coupling/averaging/layer.h"
#include "coupling/files/placement.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

constexpr double kWidth = 3;  // mean diameters: a circle of some thirty grains

}  // namespace

StrainOutcome strain_files(const StrainRequest& request) {
  require_frame(request.frame);
  const dem::Snapshot before = dem::read_snapshot(request.before.file, request.before.group);
  const dem::Snapshot after = dem::read_snapshot(request.after.file, request.after.group);
  StrainOptions options = request.options;
  if (options.width == 0) options.width = kWidth * mean_diameter(before);
  const std::int64_t loaded = before.loaded_grain >= 0 ? before.loaded_grain : after.loaded_grain;
  const Placement placed = place(before, request.frame, loaded);
  const bool grid = request.points.size() == 0;
  const Eigen::MatrixXd points =
      grid ? span_of(before, request.frame, placed.left, placed.right, placed.depth)
                 .grid(request.nx, request.ny)
           : request.points;
  StrainResult found = strain(before, after, placed.to_packing(points), options);
  StrainOutcome out;
  out.report = found.report();  // names places in the packing
  out.field = std::move(found.field);
  out.field.points = points;
  out.field.nx = grid ? request.nx : 0;
  out.field.ny = grid ? request.ny : 0;
  out.field.attributes["measure"] = options.measure;
  out.field.attributes["support"] = options.support;
  out.field.attributes["width"] = fmt::format("{}", options.width);
  out.field.attributes["h"] = fmt::format("{}", placed.depth);
  out.field.attributes["frame"] = frame_text(request.frame);
  return out;
}

}  // namespace grainfield::coupling
