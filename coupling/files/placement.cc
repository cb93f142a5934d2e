#include "coupling/files/placement.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/region.h"
#include "coupling/unknown_name.h"

namespace grainfield::coupling {
namespace {

const std::vector<std::string> kFrames{"layer", "heap", "packing"};

}  // namespace

void require_frame(const std::string& frame) {
  if (std::find(kFrames.begin(), kFrames.end(), frame) == kFrames.end())
    throw std::invalid_argument(unknown_name("frame", frame, kFrames));
}

std::string frame_text(const std::string& frame) {
  if (frame == "layer") return "models: load at (0, 0), surface y = 0";
  if (frame == "heap") return "heap: apex at (0, 0), lengths over its height h";
  return "packing";
}

Placement place(const dem::Snapshot& s, const std::string& frame, std::int64_t loaded_grain) {
  if (frame == "packing" && s.dim == 3) return {[](const auto& points) { return points; }, 0, 0, 0};
  const LayerFrame layer = layer_frame(s, loaded_grain);
  if (frame == "heap") {
    const PileFrame heap = pile_frame(s);
    const Region region(s);
    return {[heap](const auto& points) { return heap.to_packing(points); },
            (region.left() - heap.apex_x) / heap.height,
            (region.right() - heap.apex_x) / heap.height, heap.height, heap};
  }
  if (frame == "packing")
    return {[](const auto& points) { return points; }, layer.left, layer.right, layer.depth()};
  const double half = std::min(layer.load_x - layer.left, layer.right - layer.load_x);
  return {[layer](const auto& points) { return layer.to_packing(points); }, -half, half,
          layer.depth()};
}

Eigen::MatrixXd Span::grid(int columns, int rows) const {
  return grid_points(left, right, columns, bottom, top, rows);
}

Span span_of(const dem::Snapshot& snapshot, const std::string& frame, double left, double right,
             double depth) {
  if (snapshot.dim == 3)
    throw std::invalid_argument("the snapshot is 3D; give --points with x,y,z and --frame packing");
  if (frame == "heap") return {left, right, -1, 0};
  if (frame != "packing") return {left, right, -depth, 0};
  const double floor = layer_frame(snapshot).floor;
  return {left, right, floor, floor + depth};
}

}  // namespace grainfield::coupling
