#include "coupling/averaging/layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "coupling/averaging/columns.h"
#include "coupling/averaging/extent.h"
#include "coupling/averaging/roof.h"

namespace grainfield::coupling {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Mean over columns of the highest edge of a free grain whose centre is in the column.
double mean_surface(const dem::Snapshot& snapshot, double left, double right, double column) {
  const std::size_t columns = count_columns(snapshot, 0, left, right, column);
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

Eigen::RowVectorXd origin_of(const LayerFrame& frame, Eigen::Index dim) {
  if (dim == 2) return Eigen::RowVector2d(frame.load_x, frame.surface);
  return Eigen::RowVector3d(frame.load_x, frame.load_y, frame.surface);
}

// Mean height of the contacts between free and fixed grains; `otherwise` without such.
double rough_floor(const dem::Snapshot& snapshot, double otherwise) {
  double height = 0;
  int contacts = 0;
  for (const dem::Contact& contact : snapshot.contacts) {
    if (contact.j < 0) continue;
    const bool fixed_i = snapshot.grains[static_cast<std::size_t>(contact.i)].fixed;
    const bool fixed_j = snapshot.grains[static_cast<std::size_t>(contact.j)].fixed;
    if (fixed_i == fixed_j) continue;
    height += contact.point[up_axis(snapshot.dim)];
    ++contacts;
  }
  return contacts > 0 ? height / contacts : otherwise;
}

const dem::Grain* grain_of(const dem::Snapshot& snapshot, std::int64_t id) {
  for (const dem::Grain& grain : snapshot.grains)
    if (id >= 0 && grain.id == id) return &grain;
  return nullptr;
}

LayerFrame box_frame(const dem::Snapshot& snapshot, const dem::Grain* loaded) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(infinity), high = -low;
  for (const dem::Grain& grain : snapshot.grains) {
    if (grain.fixed) continue;
    for (int a = 0; a < 3; ++a) {
      const dem::Vec3 along = dem::Vec3::Unit(a);
      low[a] = std::min(low[a], grain.position[a] - dem::reach_along(grain, -along));
      high[a] = std::max(high[a], grain.position[a] + dem::reach_along(grain, along));
    }
  }
  for (const dem::Wall& wall : snapshot.walls)
    for (int a = 0; a < 3; ++a) {
      if (wall.shape != "plane") continue;
      if (wall.normal[a] > 1 - 1e-9) low[a] = wall.point[a];
      if (wall.normal[a] < -1 + 1e-9 && a < 2) high[a] = wall.point[a];
    }
  // A layer that repeats fills its cell.
  const dem::Cell<3>& cell = snapshot.cell;
  for (int a = 0; a < 2; ++a) {
    if (!cell.periodic[a] || cell.periodic[2]) continue;
    low[a] = cell.low[a];
    high[a] = cell.low[a] + cell.edges(a, a);
  }
  if (!(low.x() < high.x() && low.y() < high.y()))
    throw std::invalid_argument(
        fmt::format("no space between the packing's sides at x = {:g} and {:g} m, y = {:g} and "
                    "{:g} m: do the walls' normals point into the grains?",
                    low.x(), high.x(), low.y(), high.y()));
  low.z() = rough_floor(snapshot, low.z());
  LayerFrame frame{low.x(), high.x(), low.z(), 0, 0, low.y(), high.y(), 0};
  frame.surface = Roof(snapshot, low, high, 2 * mean_diameter(snapshot)).mean();
  frame.load_x = loaded ? loaded->position.x() : (low.x() + high.x()) / 2;
  frame.load_y = loaded ? loaded->position.y() : (low.y() + high.y()) / 2;
  return frame;
}

}  // namespace

Eigen::MatrixXd LayerFrame::to_packing(const Eigen::MatrixXd& model_points) const {
  return model_points.rowwise() + origin_of(*this, model_points.cols());
}

void MeanLayer::add(const dem::Snapshot& unloaded, const dem::Snapshot& loaded, std::size_t count) {
  const auto n = static_cast<double>(count);
  const LayerFrame frame = layer_frame(unloaded, loaded.loaded_grain);
  depth += frame.depth() / n;
  diameter += mean_diameter(unloaded) / n;
  force += -dem::total_applied_force(loaded)[up_axis(loaded.dim)] / n;
  half_width = std::min({half_width, frame.load_x - frame.left, frame.right - frame.load_x});
  if (loaded.dim == 3) {
    half_width = std::min({half_width, frame.load_y - frame.front, frame.back - frame.load_y});
  }
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
  const double diameter = mean_diameter(snapshot);
  const dem::Grain* loaded =
      grain_of(snapshot, loaded_grain >= 0 ? loaded_grain : snapshot.loaded_grain);
  if (snapshot.dim == 3) return box_frame(snapshot, loaded);
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
        "walls \"left\" and \"right\" where they say (import --wall left:x=...)?",
        frame.left, frame.right));
  frame.floor = rough_floor(snapshot, frame.floor);
  frame.surface = mean_surface(snapshot, frame.left, frame.right, 2 * diameter);
  frame.load_x = loaded ? loaded->position.x() : (frame.left + frame.right) / 2;
  return frame;
}

}  // namespace grainfield::coupling
