#include "coupling/averaging/cone.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "continuum/constants.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/roof.h"
#include "coupling/statistics/least_squares.h"

namespace grainfield::coupling {
namespace {

constexpr double kLeastShare = 0.15, kMostShare = 0.85;  // of the height: where the flank is a line
constexpr int kLeastColumns = 6;
constexpr int kRounds = 20;  // of choosing the columns of the flank

// The free grains that touch something; all of them where nothing does.
dem::Snapshot touching(const dem::Snapshot& s) {
  std::vector<bool> touches(s.grains.size(), s.contacts.empty());
  for (const dem::Contact& c : s.contacts) {
    touches[static_cast<std::size_t>(c.i)] = true;
    if (c.j >= 0) touches[static_cast<std::size_t>(c.j)] = true;
  }
  dem::Snapshot out;
  out.dim = 3;
  for (std::size_t g = 0; g < s.grains.size(); ++g)
    if (touches[g] && !s.grains[g].fixed) out.grains.push_back(s.grains[g]);
  return out;
}

struct Flank {
  double top = kNan, slope = kNan;  // height above the floor on the axis, fall per length
};

struct SurfacePoint {
  double away, height;  // from the axis; above the floor
  bool operator==(const SurfacePoint&) const = default;
};

Flank line_through(const std::vector<SurfacePoint>& points) {
  if (points.size() < kLeastColumns) return {};
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd line(n, 2), heights(n, 1);
  for (Eigen::Index k = 0; k < n; ++k) {
    const SurfacePoint& p = points[static_cast<std::size_t>(k)];
    line.row(k) << 1, -p.away;
    heights(k, 0) = p.height;
  }
  const Eigen::MatrixXd solved = least_squares(line, heights).solution;
  if (!(solved(1, 0) > 0)) return {};
  return {solved(0, 0), solved(1, 0)};
}

// Columns are chosen by the height of the line there: by their own it would be too flat. `sector`:
// of it alone; -1: of all.
Flank flank_of(const Roof& roof, const ConeFrame& frame, int sector = -1) {
  const double low = kLeastShare * frame.height, high = kMostShare * frame.height;
  std::vector<SurfacePoint> all, chosen;
  for (Eigen::Index i = 0; i < roof.heights().rows(); ++i) {
    for (Eigen::Index j = 0; j < roof.heights().cols(); ++j) {
      const Eigen::Vector2d out = roof.middle(i, j) - Eigen::Vector2d(frame.apex_x, frame.apex_y);
      if (sector >= 0 && cone_sector(out.x(), out.y()) != sector) continue;
      if (!(roof.heights()(i, j) > frame.floor)) continue;  // no grain
      all.push_back({out.norm(), roof.heights()(i, j) - frame.floor});
      if (all.back().height > low && all.back().height < high) chosen.push_back(all.back());
    }
  }
  Flank flank = line_through(chosen);
  for (int round = 0; round < kRounds && std::isfinite(flank.slope); ++round) {
    std::vector<SurfacePoint> next;
    for (const SurfacePoint& p : all) {
      const double at = flank.top - flank.slope * p.away;
      if (at > low && at < high) next.push_back(p);
    }
    const Flank better = line_through(next);
    if (next == chosen || !std::isfinite(better.slope)) break;
    chosen = std::move(next);
    flank = better;
  }
  return flank;
}

double fraction_inside(const dem::Snapshot& grains, const ConeFrame& frame, const Flank& flank,
                       const Roof& roof) {
  const double d = frame.diameter, bottom = d;
  const double top = flank.top - 2 * d * std::hypot(1.0, flank.slope), height = top - bottom;
  double volume = 0;
  if (height > 4 * d) {
    for (const dem::Grain& g : grains.grains) {
      const double z = g.position.z() - frame.floor;
      const double r = std::hypot(g.position.x() - frame.apex_x, g.position.y() - frame.apex_y);
      if (z > bottom && z < top - flank.slope * r) volume += g.volume;
    }
    const double radius = height / flank.slope;
    return volume / (std::numbers::pi / 3 * radius * radius * height);
  }
  for (const dem::Grain& g : grains.grains) volume += g.volume;
  const Eigen::Vector2d column = roof.middle(1, 1) - roof.middle(0, 0);
  return volume / ((roof.heights().array() - frame.floor).sum() * column.prod());
}

}  // namespace

int cone_sector(double x, double y) {
  const double turns = std::atan2(y, x) / (2 * std::numbers::pi);
  return static_cast<int>(std::floor((turns < 0 ? turns + 1 : turns) * kConeSectors)) %
         kConeSectors;
}

double ConeFrame::apex_height() const {
  return std::isfinite(repose_deg) ? foot * std::tan(repose_deg * kDegree) : height;
}

Eigen::MatrixXd ConeFrame::to_packing(const Eigen::MatrixXd& scaled) const {
  return (height * scaled).rowwise() + Eigen::RowVector3d(apex_x, apex_y, floor + height);
}

ConeFrame cone_frame(const dem::Snapshot& heap) {
  if (heap.dim != 3) throw std::invalid_argument("the snapshot is 2D; a cone needs a 3D one");
  const LayerFrame layer = layer_frame(heap);
  const dem::Snapshot grains = touching(heap);
  ConeFrame frame;
  frame.floor = layer.floor;
  frame.diameter = mean_diameter(grains);
  frame.gravity = heap.gravity.norm();
  double mass = 0, volume = 0, reach = 0;
  Eigen::Vector2d centroid(0, 0);
  for (const dem::Grain& g : grains.grains) {
    mass += g.mass;
    volume += g.volume;
    centroid += g.volume * g.position.head<2>();
  }
  centroid /= volume;
  frame.apex_x = centroid.x();
  frame.apex_y = centroid.y();
  frame.grain_density = mass / volume;
  for (const dem::Grain& g : grains.grains)
    reach = std::max(reach, (g.position.head<2>() - centroid).norm() + g.radius);
  const Roof roof(grains, {centroid.x() - reach, centroid.y() - reach, frame.floor},
                  {centroid.x() + reach, centroid.y() + reach, 0}, 2 * frame.diameter);
  frame.height = roof.highest() - frame.floor;
  const Flank flank = flank_of(roof, frame);
  frame.foot = std::isfinite(flank.slope) ? flank.top / flank.slope : reach;
  frame.repose_deg = std::atan(flank.slope) / kDegree;
  for (int k = 0; k < kConeSectors; ++k) {
    frame.sector_repose_deg[static_cast<std::size_t>(k)] =
        std::atan(flank_of(roof, frame, k).slope) / kDegree;
  }
  frame.volume_fraction = fraction_inside(grains, frame, flank, roof);
  return frame;
}

}  // namespace grainfield::coupling
