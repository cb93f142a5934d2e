#include "dem/snapshot/images.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "dem/snapshot/cell_places.h"

namespace grainfield::dem {
namespace {

// As images are counted.
int whole(double turns) {
  if (std::fabs(turns) <= kMostImages) return static_cast<int>(turns);
  throw TooFarAway(fmt::format("a place {:g} edges of the periodic cell away, allowed: up to {}",
                               turns, kMostImages));
}

}  // namespace

Vec3 along_edges(const Cell<3>& cell, const Vec3& v) {
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero();
  for (int a = 0; a < 3; ++a)
    if (cell.periodic[static_cast<std::size_t>(a)]) edges.col(a) = cell.edges.col(a);
  Eigen::Matrix3d square = edges.transpose() * edges;
  for (int a = 0; a < 3; ++a)
    if (!cell.periodic[static_cast<std::size_t>(a)]) square(a, a) = 1;
  return square.ldlt().solve(edges.transpose() * v);
}

Vec3 shift_to(const Cell<3>& cell, const std::array<int, 3>& image) {
  Vec3 shift = Vec3::Zero();
  for (std::size_t a = 0; a < 3; ++a)
    if (image[a] != 0 && cell.periodic[a])
      shift += image[a] * cell.edges.col(static_cast<Eigen::Index>(a));
  return shift;
}

std::array<int, 3> nearest_image(const Cell<3>& cell, const Vec3& branch) {
  std::array<int, 3> best{0, 0, 0}, middle{0, 0, 0};
  if (!cell.is_periodic()) return best;
  const Vec3 turns = along_edges(cell, branch);
  std::array<int, 3> reach{0, 0, 0};
  for (std::size_t a = 0; a < 3; ++a) {
    middle[a] = -whole(std::round(turns[static_cast<Eigen::Index>(a)]));
    reach[a] = cell.periodic[a] ? 1 : 0;
  }
  // In a tilted cell a neighbour of the rounded one may be nearer.
  double least = branch.squaredNorm();
  for (int i = -reach[0]; i <= reach[0]; ++i)
    for (int j = -reach[1]; j <= reach[1]; ++j)
      for (int k = -reach[2]; k <= reach[2]; ++k) {
        const std::array<int, 3> image{middle[0] + i, middle[1] + j, middle[2] + k};
        const double squared = (branch + shift_to(cell, image)).squaredNorm();
        if (squared >= least) continue;
        least = squared;
        best = image;
      }
  return best;
}

Eigen::Matrix3i edges_exchanged(const Cell<3>& after, const Cell<3>& before) {
  Eigen::Matrix3i exchange = Eigen::Matrix3i::Identity();
  for (int a = 0; a < 3; ++a) {
    if (!before.periodic[a] || !after.periodic[a]) continue;
    const Vec3 turns = along_edges(after, before.edges.col(a));
    for (int b = 0; b < 3; ++b)
      exchange(b, a) =
          after.periodic[b] ? static_cast<int>(std::round(std::clamp(turns[b], -2.0, 2.0))) : 0;
  }
  const bool once = exchange.cwiseAbs().maxCoeff() <= 1;
  return once && std::abs(exchange.determinant()) == 1 ? exchange : Eigen::Matrix3i::Identity();
}

std::array<int, 3> image_in(const Cell<3>& after, const Cell<3>& before,
                            const std::array<int, 3>& image) {
  if (image == std::array<int, 3>{0, 0, 0}) return image;
  const Eigen::Vector3i out =
      edges_exchanged(after, before) * Eigen::Vector3i(image[0], image[1], image[2]);
  return {out[0], out[1], out[2]};
}

std::array<int, 3> edges_away(const Cell<3>& cell, const Vec3& place) {
  std::array<int, 3> away{0, 0, 0};
  if (!cell.is_periodic()) return away;
  const Vec3 turns = along_edges(cell, place - cell.low);
  for (std::size_t a = 0; a < 3; ++a)
    away[a] = whole(std::floor(turns[static_cast<Eigen::Index>(a)]));
  return away;
}

double depth_outside(const Cell<3>& cell, const Vec3& place) {
  if (!cell.is_periodic()) return 0;
  const Vec3 turns = along_edges(cell, place - cell.low);
  double depth = 0;
  for (Eigen::Index a = 0; a < 3; ++a) {
    if (!cell.periodic[static_cast<std::size_t>(a)]) continue;
    depth = std::max(depth, std::max(-turns[a], turns[a] - 1) * cell.edges.col(a).norm());
  }
  return depth;
}

Vec3 wrapped(const Cell<3>& cell, const Vec3& place) {
  const std::array<int, 3> away = edges_away(cell, place);
  if (away == std::array<int, 3>{0, 0, 0}) return place;
  return place + shift_to(cell, {-away[0], -away[1], -away[2]});
}

}  // namespace grainfield::dem
