#include "coupling/averaging/contact_geometry.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "dem/shapes/common_normal.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;

Eigen::Matrix3d turn_of(const dem::Grain& g) {
  return Eigen::Quaterniond(g.orientation[0], g.orientation[1], g.orientation[2], g.orientation[3])
      .normalized()
      .toRotationMatrix();
}

// A sphere is one with three equal axes.
dem::Superellipsoid shape_of(const dem::Grain& g) {
  if (g.axes.isZero(0)) return dem::superellipsoid({g.radius, g.radius, g.radius}, {1, 1});
  return dem::superellipsoid({g.axes[0], g.axes[1], g.axes[2]}, g.exponents);
}

// Corners of a polygon about its centre, in space.
std::vector<Vec3> corners_of(const dem::Grain& g) {
  const double cosine = std::cos(g.angle), sine = std::sin(g.angle);
  std::vector<Vec3> out;
  for (const auto& [x, y] : g.outline)
    out.emplace_back(cosine * x - sine * y, sine * x + cosine * y, 0);
  return out;
}

// Outward normals of a polygon's edges.
std::vector<Vec3> edge_normals(const std::vector<Vec3>& corners) {
  std::vector<Vec3> out;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 edge = corners[(k + 1) % corners.size()] - corners[k];
    const Vec3 normal(edge.y(), -edge.x(), 0);
    if (normal.norm() > 0) out.push_back(normal.normalized());
  }
  return out;
}

// Reach of a body with these corners, or of a disk without, along a unit vector.
double reach_of(const std::vector<Vec3>& corners, double radius, const Vec3& along) {
  if (corners.empty()) return radius;
  double most = -std::numeric_limits<double>::infinity();
  for (const Vec3& corner : corners) most = std::max(most, corner.dot(along));
  return most;
}

// Two convex bodies in the plane are apart exactly where a normal of an edge parts them, or, of a
// disk, the line from its centre to the nearest corner.
double plane_gap(const dem::Grain& a, const dem::Grain& b, const Vec3& branch) {
  const std::vector<Vec3> of_a = corners_of(a), of_b = corners_of(b);
  std::vector<Vec3> along = edge_normals(of_a);
  for (const Vec3& normal : edge_normals(of_b)) along.push_back(-normal);
  const auto add_nearest = [&](const std::vector<Vec3>& corners, const Vec3& centre, double sign) {
    if (corners.empty()) return;
    const Vec3& nearest =
        *std::min_element(corners.begin(), corners.end(), [&](const Vec3& p, const Vec3& q) {
          return (p - centre).squaredNorm() < (q - centre).squaredNorm();
        });
    if ((centre - nearest).norm() > 0) along.push_back(sign * (centre - nearest).normalized());
  };
  if (of_b.empty()) add_nearest(of_a, branch, 1);
  if (of_a.empty()) add_nearest(of_b, -branch, -1);
  double most = -std::numeric_limits<double>::infinity();
  for (const Vec3& n : along)
    most =
        std::max(most, n.dot(branch) - reach_of(of_a, a.radius, n) - reach_of(of_b, b.radius, -n));
  return most;
}

}  // namespace

Vec3 farthest_along(const dem::Grain& g, const Vec3& direction) {
  if (!g.axes.isZero(0)) {
    const Eigen::Matrix3d turn = turn_of(g);
    return g.position + turn * dem::support_of(shape_of(g), turn.transpose() * direction).point;
  }
  if (g.outline.empty()) return g.position + g.radius * direction;
  const std::vector<Vec3> corners = corners_of(g);
  return g.position +
         *std::max_element(corners.begin(), corners.end(), [&](const Vec3& p, const Vec3& q) {
           return p.dot(direction) < q.dot(direction);
         });
}

CommonPlane common_plane(const dem::Grain& first, const dem::Grain& second, const Vec3& branch) {
  const dem::Superellipsoid a = shape_of(first), b = shape_of(second);
  const Eigen::Matrix3d turn_a = turn_of(first), turn_b = turn_of(second);
  dem::PairNormal memory;
  dem::CommonNormal found;
  dem::common_normal({a, turn_a, dem::farthest_of(a), dem::nearest_of(a)},
                     {b, turn_b, dem::farthest_of(b), dem::nearest_of(b)}, branch, memory, found);
  // Apart the search ends with the first direction that proves it.
  if (found.normal.isZero(0)) found.normal = memory.empty() ? branch.normalized() : memory.normal;
  if (found.depth > 0) return {found.normal, found.point, -found.depth};
  const Vec3 from = farthest_along(first, found.normal) - first.position,
             to = branch + farthest_along(second, -found.normal) - second.position;
  return {found.normal, 0.5 * (from + to), found.normal.dot(to - from)};
}

double gap_of(const dem::Snapshot& s, const dem::Contact& c) {
  const dem::Grain& a = s.grains[static_cast<std::size_t>(c.i)];
  if (c.j < 0) {
    const dem::Wall& wall = s.walls[static_cast<std::size_t>(-1 - c.j)];
    if (wall.shape != "plane") return 0;
    return (farthest_along(a, -wall.normal) - wall.point).dot(wall.normal);
  }
  const dem::Grain& b = s.grains[static_cast<std::size_t>(c.j)];
  const Vec3 branch = dem::second_place(s, c) - a.position;
  const double apart = branch.norm() - a.radius - b.radius;
  const bool solids = !a.axes.isZero(0) || !b.axes.isZero(0);
  const bool polygons = !a.outline.empty() || !b.outline.empty();
  if (apart > 0 || (!solids && !polygons)) return apart;
  return solids ? common_plane(a, b, branch).gap : plane_gap(a, b, branch);
}

namespace {

bool is_idle(const dem::Snapshot& s, const dem::Contact& c) {
  if (!c.force.isZero(0)) return false;
  double radius = s.grains[static_cast<std::size_t>(c.i)].radius;
  if (c.j >= 0) radius = std::min(radius, s.grains[static_cast<std::size_t>(c.j)].radius);
  return gap_of(s, c) > kGap * radius;
}

}  // namespace

std::size_t leave_out_idle(dem::Snapshot& s) {
  return std::erase_if(s.contacts, [&](const dem::Contact& c) { return is_idle(s, c); });
}

std::size_t count_idle(const dem::Snapshot& s) {
  return static_cast<std::size_t>(std::count_if(
      s.contacts.begin(), s.contacts.end(), [&](const dem::Contact& c) { return is_idle(s, c); }));
}

std::string idle_text(std::size_t count) {
  if (count == 0) return "";
  return fmt::format("{} pairs bear no force and do not touch (a gap): they are left out", count);
}

}  // namespace grainfield::coupling
