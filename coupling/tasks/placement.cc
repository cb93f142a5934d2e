#include "coupling/tasks/placement.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/cone.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/region.h"
#include "coupling/base/unknown_name.h"

namespace grainfield::coupling {
namespace {

constexpr double kBeyondFoot = 1.1;

const std::vector<std::string> kFrames{"layer", "heap", "packing"};

Placement place_in_space(const dem::Snapshot& s, const std::string& frame,
                         std::int64_t loaded_grain) {
  if (frame == "heap") {
    const ConeFrame cone = cone_frame(s);
    PileFrame heap;
    heap.apex_x = cone.apex_x;
    heap.floor = cone.floor;
    heap.height = cone.height;
    heap.half_left = heap.half_right = cone.foot;
    heap.repose_left_deg = heap.repose_right_deg = cone.repose_deg;
    heap.volume_fraction = cone.volume_fraction;
    heap.grain_density = cone.grain_density;
    heap.gravity = cone.gravity;
    heap.diameter = cone.diameter;
    const double foot = cone.foot / cone.height;
    return {[cone](const auto& points) { return cone.to_packing(points); },
            -foot,
            foot,
            cone.height,
            heap,
            -foot,
            foot};
  }
  const LayerFrame layer = layer_frame(s, loaded_grain);
  if (frame == "packing")
    return {[](const auto& points) { return points; },
            layer.left,
            layer.right,
            layer.depth(),
            {},
            layer.front,
            layer.back};
  const double half_x = std::min(layer.load_x - layer.left, layer.right - layer.load_x),
               half_y = std::min(layer.load_y - layer.front, layer.back - layer.load_y);
  return {[layer](const auto& points) { return layer.to_packing(points); },
          -half_x,
          half_x,
          layer.depth(),
          {},
          -half_y,
          half_y};
}

}  // namespace

void require_frame(const std::string& frame) {
  if (std::find(kFrames.begin(), kFrames.end(), frame) == kFrames.end())
    throw std::invalid_argument(unknown_name("frame", frame, kFrames));
}

Placement place(const dem::Snapshot& s, const std::string& frame, std::int64_t loaded_grain) {
  if (s.dim == 3) return place_in_space(s, frame, loaded_grain);
  const LayerFrame layer = layer_frame(s, loaded_grain);
  if (frame == "heap") {
    const PileFrame heap = pile_frame(s);
    const Region region(s);
    // From foot to foot and a little beyond; the floor may be many times as long.
    const double left = std::max(region.left() - heap.apex_x, -kBeyondFoot * heap.half_left);
    const double right = std::min(region.right() - heap.apex_x, kBeyondFoot * heap.half_right);
    return {[heap](const auto& points) { return heap.to_packing(points); }, left / heap.height,
            right / heap.height, heap.height, heap};
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

Eigen::MatrixXd Span::grid(int columns, int rows, int layers) const {
  return box_points({left, front, bottom}, {right, back, top}, columns, rows, layers);
}

Span span_of(const dem::Snapshot& snapshot, const std::string& frame, const Span& sides,
             double depth) {
  Span out = sides;
  if (frame == "packing") {
    out.bottom = layer_frame(snapshot).floor;
    out.top = out.bottom + depth;
  } else {
    out.bottom = frame == "heap" ? -1 : -depth;
    out.top = 0;
  }
  return out;
}

}  // namespace grainfield::coupling
