#include "dem/quasistatic/superellipsoid_network.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dem/quasistatic/sphere_contact.h"
#include "dem/space/elementary.h"
#include "dem/space/kinematics3.h"

namespace grainfield::dem {
namespace {

// Contacts that do not touch yet have the stiffness of this depth, as a share of the radius.
constexpr double kLightDepth = 1e-5;
// Steps of the central differences, in radii: this share of the overlap's depth, over which forces
// are smooth, within bounds. Round-off leaves 1e-14 / step, truncation step^2 / depth^2.
constexpr double kStepShare = 1e-3, kLeastStep = 1e-9, kMostStep = 1e-6;
// The search for the common normal ends when the depth is known (common_normal.h), where the
// normal may be off by 1e-6. Searched again it is known to the last digits, and so are the
// curvatures, of which derivatives are taken: until it turns by less, or rests after so many
// searches. Far from its start it takes more, each of which turns it by kMostTurn at most.
constexpr double kLeastTurn = 1e-10;
constexpr int kSearches = 4, kMostSearches = 40;
// What the search leaves of a contact's size, over it, and more.
constexpr double kRounded = 1e-9;

Eigen::Matrix3d turned(const RotationOf<3>& committed, const Vec3& turn) {
  return (quaternion_of(turn) * committed).normalized().toRotationMatrix();
}

}  // namespace

SuperellipsoidContacts::SuperellipsoidContacts(const Snapshot& start, const Materials& materials)
    : law_(materials.law) {
  if (materials.rolling.on()) {
    throw std::invalid_argument(
        "quasi-static relaxation of superellipsoids: found resistance against rolling "
        "(material.rolling_friction or twisting_friction above 0), allowed: none");
  }
  for (const Grain& g : start.grains) {
    Shape& s = shapes_.emplace_back();
    s.body = superellipsoid({g.axes[0], g.axes[1], g.axes[2]}, g.exponents);
    s.farthest = farthest_of(s.body);
    s.nearest = nearest_of(s.body);
    s.equal_radius = cube_root(volume_of(s.body) / (4.0 / 3 * std::numbers::pi));
  }
}

/// Not touched: the spring is taken as it is at the present normal.
SuperellipsoidMemory SuperellipsoidContacts::memory_of(const Contact& c) {
  SuperellipsoidMemory out;
  out.spring =
      c.spring_vector.allFinite() ? c.spring_vector : Vec3(c.force + c.normal_force * c.normal);
  out.known.normal = c.normal;
  out.known.touching = 1;
  return out;
}

/// The contact point is in the middle between the surface and the plane.
bool SuperellipsoidContacts::overlap_plane(const PlacedPair& pair, const PairMotion& m,
                                           Overlap3& o) const {
  const Shape& shape = shapes_[pair.i];
  const double height = (m.shift - pair.across).dot(pair.plane);
  if (height >= shape.farthest) return false;
  const Eigen::Matrix3d turn = turned(pair.turned_i, m.turn_i);
  const Vec3 n = -pair.plane;
  const Support s = support_of(shape.body, turn.transpose() * n);
  if (s.height <= height) return false;
  o.normal = n;
  o.depth = s.height - height;
  o.arm_i = turn * s.point - 0.5 * o.depth * n;
  o.arm_j.setZero();  // a plane does not turn
  const Tangents t = tangents_of(n);
  o.major = t.x;
  if (!law_.curvatures()) return true;
  const TurnedBody body{shape.body, turn, shape.farthest, shape.nearest};
  const PlanePrincipal relative = relative_curvatures(bend_of(s, body.in_body(t)));
  o.radius = shape.equal_radius;
  o.lesser_curvature = relative.lesser;
  o.greater_curvature = relative.greater;
  o.major = across_of(relative, t);
  return true;
}

bool SuperellipsoidContacts::overlap(const PlacedPair& pair, const PairMotion& m, PairNormal& known,
                                     Overlap3& o) const {
  if (pair.is_plane()) return overlap_plane(pair, m, o);
  const Shape &a = shapes_[pair.i], &b = shapes_[pair.j];
  const Vec3 across = pair.across - m.shift;
  const double reach = a.farthest + b.farthest;
  if (across.squaredNorm() >= reach * reach) return false;
  const Eigen::Matrix3d turn_i = turned(pair.turned_i, m.turn_i),
                        turn_j = turned(pair.turned_j, m.turn_j);
  const TurnedBody first{a.body, turn_i, a.farthest, a.nearest},
      second{b.body, turn_j, b.farthest, b.nearest};
  CommonNormal found;
  for (int k = 0; k < kMostSearches; ++k) {
    const Vec3 before = known.normal;
    if (!common_normal(first, second, across, known, found, law_.curvatures())) return false;
    if ((found.normal - before).squaredNorm() < kLeastTurn * kLeastTurn) break;
    if (k + 1 >= kSearches && found.settled) break;
  }
  o.normal = found.normal;
  o.depth = found.depth;
  o.arm_i = found.point;
  o.arm_j = found.point - across;
  o.major = tangents_of(o.normal).x;
  if (!law_.curvatures()) return true;
  o.radius = a.equal_radius * b.equal_radius / (a.equal_radius + b.equal_radius);
  o.lesser_curvature = found.lesser_curvature;
  o.greater_curvature = found.greater_curvature;
  o.major = found.major;
  return true;
}

bool SuperellipsoidContacts::force(const PlacedPair& pair, const Memory& memory,
                                   const PairMotion& m, const Force* branches, Force& out) const {
  Overlap3 o;
  out.reached = {};
  out.reached.known = memory.known;
  if (!overlap(pair, m, out.reached.known, o)) return false;
  const Vec3& n = o.normal;
  out.normal = law_.repulsion(o);
  const double size = law_.spring(o).size;

  // What was: of a contact that was open, what is. The spring grows at the depth halfway.
  const Vec3 halfway = memory.touched ? Vec3((memory.normal + n).normalized()) : n;
  Vec3 arm_i = o.arm_i, arm_j = o.arm_j;
  double share = 1, closed = 1;
  Overlap3 at = o;
  if (memory.touched) {
    arm_i = 0.5 * (arm_i + memory.arm_i);
    arm_j = 0.5 * (arm_j + memory.arm_j);
    out.shrinks = branches != nullptr ? branches->shrinks : size < memory.size;
    if (out.shrinks || law_.follows_size()) {
      share = memory.size > 0 ? size / memory.size : 1;
    } else {
      at.depth = 0.5 * (memory.depth + o.depth);
    }
  } else {
    const double approach = (m.shift + m.turn_i.cross(arm_i) - m.turn_j.cross(arm_j)).dot(n);
    if (approach > o.depth) closed = o.depth / approach;
    at.depth = 0.5 * o.depth;
  }

  Vec3 slip = m.shift + m.turn_i.cross(arm_i) - m.turn_j.cross(arm_j);
  slip -= slip.dot(halfway) * halfway;
  slip = closed * sphere_contact::carried(slip, halfway, n);
  Vec3 spring = share * memory.spring;
  turn_with_material(spring, n, 0.5 * (m.turn_i + m.turn_j));
  const SuperellipsoidLaw::Spring k = law_.spring(at);
  const Vec3 minor = n.cross(o.major);
  spring -= k.major * slip.dot(o.major) * o.major + k.minor * slip.dot(minor) * minor;

  const double limit = pair.friction * out.normal, along = spring.norm();
  out.slides = branches != nullptr ? branches->slides : along >= limit;
  out.friction = spring;
  if (out.slides) out.friction *= along > 0 ? limit / along : 0;
  out.force = out.friction - out.normal * n;
  out.moment_i = o.arm_i.cross(out.force);
  out.moment_j = -o.arm_j.cross(out.force);
  out.reached = {true, n, o.depth, size, o.arm_i, o.arm_j, out.friction, out.reached.known};
  return true;
}

bool SuperellipsoidContacts::slopes(const PlacedPair& pair, const Memory& memory,
                                    const PairMotion& at, PairSlopes& out) const {
  Force middle;
  if (!force(pair, memory, at, middle)) return false;
  // What has not moved has its size and spring but for rounding: it grows, and if it slid it
  // slides.
  middle.shrinks = middle.reached.size < (1 - kRounded) * memory.size;
  middle.slides = middle.friction.norm() >= (1 - kSlidingMargin) * pair.friction * middle.normal;
  Memory near = memory;
  near.known = middle.reached.known;
  const double radius = shapes_[pair.i].farthest;
  const double step = std::clamp(kStepShare * middle.reached.depth / radius, kLeastStep, kMostStep);
  out.setZero();
  for (int column = 0; column < (pair.is_plane() ? 6 : 9); ++column) {
    const double h = column < 3 ? step * radius : step;
    for (const double side : {-1.0, 1.0}) {
      PairMotion m = at;
      Vec3& moved = column < 3 ? m.shift : column < 6 ? m.turn_i : m.turn_j;
      moved[column % 3] += side * h;
      Force f;
      if (!force(pair, near, m, &middle, f)) continue;  // 0: they do not touch there
      out.col(column) +=
          side / (2 * h) *
          (Eigen::Matrix<double, 9, 1>() << f.force, f.moment_i, f.moment_j).finished();
    }
  }
  return true;
}

double SuperellipsoidContacts::stiffness(const PlacedPair& pair, const Memory& memory) const {
  Overlap3 o;
  PairNormal known = memory.known;
  if (!overlap(pair, {}, known, o)) return 0;
  Overlap3 more = o, less = o;
  more.depth += kStepShare * o.depth;
  less.depth -= kStepShare * o.depth;
  return (law_.repulsion(more) - law_.repulsion(less)) / (more.depth - less.depth);
}

double SuperellipsoidContacts::stiffness(double radius) const {
  Overlap3 more, less;
  for (Overlap3* o : {&more, &less}) {
    o->radius = 0.5 * radius;
    o->lesser_curvature = o->greater_curvature = 1 / radius;
  }
  more.depth = (1 + kStepShare) * kLightDepth * radius;
  less.depth = (1 - kStepShare) * kLightDepth * radius;
  return (law_.repulsion(more) - law_.repulsion(less)) / (more.depth - less.depth);
}

}  // namespace grainfield::dem
