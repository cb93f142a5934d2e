#include "coupling/averaging/layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "coupling/averaging/extent.h"

namespace grainfield::coupling {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Mean over columns of the highest edge of a free grain whose centre is in the column.
double mean_surface(const dem::Snapshot& snapshot, double left, double right, double column) {
  const auto columns = static_cast<std::size_t>(std::max(1.0, std::floor((right - left) / column)));
  std::vector<double> top(columns, -infinity);
  for (const dem::Grain& grain : snapshot.grains) {
    if (grain.fixed) continue;
    const double at = (grain.position.x() - left) / (right - left) * static_cast<double>(columns);
    const auto k =
        static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(columns - 1)));
    top[k] = std::max(top[k], top_of(grain));
  }
  double sum = 0;
  int count = 0;
  for (double height : top)
    if (height > -infinity) {
      sum += height;
      ++count;
    }
  return sum / count;
}

}  // namespace

Eigen::MatrixXd LayerFrame::to_packing(const Eigen::MatrixXd& model_points) const {
  return model_points.rowwise() + Eigen::RowVector2d(load_x, surface);
}

Eigen::MatrixXd LayerFrame::to_model(const Eigen::MatrixXd& packing_points) const {
  return packing_points.rowwise() - Eigen::RowVector2d(load_x, surface);
}

double mean_diameter(const dem::Snapshot& snapshot) {
  double sum = 0;
  int count = 0;
  for (const dem::Grain& grain : snapshot.grains)
    if (!grain.fixed) {
      sum += 2 * grain.radius;
      ++count;
    }
  if (count == 0) throw std::invalid_argument("the snapshot has no free grain");
  return sum / count;
}

LayerFrame layer_frame(const dem::Snapshot& snapshot, std::int64_t loaded_grain) {
  if (snapshot.dim != 2) throw std::invalid_argument("the snapshot is 3D; a 2D one is needed");
  const double diameter = mean_diameter(snapshot);
  LayerFrame frame{infinity, -infinity, infinity, -infinity, 0};
  for (const dem::Grain& grain : snapshot.grains) {
    if (grain.fixed) continue;
    frame.left = std::min(frame.left, left_of(grain));
    frame.right = std::max(frame.right, right_of(grain));
    frame.floor = std::min(frame.floor, bottom_of(grain));
  }
  for (const dem::Wall& wall : snapshot.walls) {
    if (wall.name == "left") frame.left = wall.point.x();
    if (wall.name == "right") frame.right = wall.point.x();
    if (wall.name == "floor") frame.floor = wall.point.y();
  }
  const auto between = [&](const dem::Grain& grain) {
    return !grain.fixed && grain.position.x() >= frame.left && grain.position.x() <= frame.right;
  };
  if (std::none_of(snapshot.grains.begin(), snapshot.grains.end(), between))
    throw std::invalid_argument(fmt::format(
        "no free grain lies between the packing's sides at x = {:g} and {:g} m: are the "
        "walls \"left\" and \"right\" where they say?",
        frame.left, frame.right));
  double height = 0;
  int contacts = 0;
  for (const dem::Contact& contact : snapshot.contacts) {
    if (contact.j < 0) continue;
    const bool fixed_i = snapshot.grains[static_cast<std::size_t>(contact.i)].fixed;
    const bool fixed_j = snapshot.grains[static_cast<std::size_t>(contact.j)].fixed;
    if (fixed_i == fixed_j) continue;
    height += contact.point.y();
    ++contacts;
  }
  if (contacts > 0) frame.floor = height / contacts;
  frame.surface = mean_surface(snapshot, frame.left, frame.right, 2 * diameter);
  frame.load_x = (frame.left + frame.right) / 2;
  const std::int64_t id = loaded_grain >= 0 ? loaded_grain : snapshot.loaded_grain;
  for (const dem::Grain& grain : snapshot.grains)
    if (id >= 0 && grain.id == id) frame.load_x = grain.position.x();
  return frame;
}

}  // namespace grainfield::coupling
