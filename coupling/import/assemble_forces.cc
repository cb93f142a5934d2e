// Forces that are told by sizes and directions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/import/assemble_contacts.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;

// Tolerance for a tangential direction's length and its cosine to the normal: few digits leave it.
constexpr double kOffUnit = 1e-2;
// Share of the normal force that is rounding, whose direction is any.
constexpr double kNoForce = 1e-6;

// Radii between the misses of a normal and of its opposite where the one is meant: of a pair that
// touches through both sides of a cell each misses by its overlap.
constexpr double kOtherSide = 0.5;

}  // namespace

void Assembly::check_tangent(const ForeignRow& row, const Vec3& normal, Vec3& tangent) {
  const double length = tangent.norm();
  if (!(std::abs(length - 1) <= kOffUnit && std::abs(tangent.dot(normal)) <= kOffUnit))
    row.refuse(fmt::format(
        "columns tx, ty, tz: found a direction of length {:g} at {:.3g} degrees from the normal, "
        "allowed: 1 at 90 degrees; what are no directions (torques, forces) take another name: "
        "--column ftx,fty,ftz=... are the components of a tangential force",
        length,
        std::acos(std::clamp(tangent.dot(normal) / length, -1.0, 1.0)) * 180 / std::numbers::pi));
  tangent /= length;
}

dem::Vec3 Assembly::normal_of_shapes(const ForeignRow& row, const dem::Contact& c) const {
  const dem::Snapshot& s = out_.snapshot;
  if (c.j < 0) return -s.walls[static_cast<std::size_t>(-1 - c.j)].normal;
  const dem::Grain &a = s.grains[static_cast<std::size_t>(c.i)],
                   &b = s.grains[static_cast<std::size_t>(c.j)];
  for (const dem::Grain* grain : {&a, &b})
    if (!grain->outline.empty() || !grain->axes.isZero(0))
      row.refuse("column fn: a size, and no normal: nx, ny (3D: nz) tell its direction");
  const Vec3 branch = b.position - a.position;
  return branch + dem::shift_to(s.cell, dem::nearest_image(s.cell, branch));
}

bool Assembly::points_backwards(const dem::Contact& c, const Vec3& normal) const {
  const dem::Snapshot& s = out_.snapshot;
  if (c.j < 0) return normal.dot(s.walls[static_cast<std::size_t>(-1 - c.j)].normal) > 0;
  const dem::Grain &a = s.grains[static_cast<std::size_t>(c.i)],
                   &b = s.grains[static_cast<std::size_t>(c.j)];
  for (const dem::Grain* grain : {&a, &b})
    if (!grain->outline.empty() || !grain->axes.isZero(0)) return false;
  // Through either side of a narrow cell: the end of the normal is nearer to j, or its other end.
  const auto miss = [&](double way) {
    const Vec3 off = b.position - a.position - way * (a.radius + b.radius) * normal;
    return (off + dem::shift_to(s.cell, dem::nearest_image(s.cell, off))).norm();
  };
  return miss(-1) + kOtherSide * std::min(a.radius, b.radius) < miss(1);
}

dem::Vec3 Assembly::force_of_sizes(const ContactColumns& columns, const ForeignRow& row,
                                   const dem::Contact& c, double side) const {
  const double fn = row.number(columns.fn), ft = columns.ft ? row.number(columns.ft) : 0;
  const dem::Snapshot& s = out_.snapshot;
  // Seen from the grain where a wall is first.
  const bool together = format_.directions_turn_together;
  Vec3 normal = columns.normal ? Vec3((together ? 1 : side) * columns.normal.of(row))
                               : normal_of_shapes(row, c),
       tangent = Vec3::Zero();
  const double length = normal.norm();
  if (!(length > 0 && std::isfinite(length)))
    row.refuse(fmt::format("the contact's normal has length {:g}", length));
  normal /= length;
  double sign = 1;
  if (columns.tangential_part) {
    // A size pushes along the line of centres, whichever way the file's normal points.
    if (points_backwards(c, normal)) normal = -normal;
    return side * format_.force_sign * columns.tangential_part.of(row) - fn * normal;
  }
  if (columns.tangent) {
    tangent = (together ? 1 : side) * columns.tangent.of(row);
    if (std::abs(ft) > kNoForce * std::abs(fn)) check_tangent(row, normal, tangent);
    sign = format_.force_sign;
  } else if (s.dim == 2) {
    tangent = {-normal.y(), normal.x(), 0};
  } else if (ft != 0) {
    row.refuse("column ft: a size, and no direction: tx, ty, tz tell it");
  }
  if (!together) return sign * ft * tangent - fn * normal;
  // MercuryDPM: towards i of a pair, away from it of a wall, and the tangent likewise.
  const Vec3 outwards = c.point - s.grains[static_cast<std::size_t>(c.i)].position;
  const Vec3 near = outwards + dem::shift_to(s.cell, dem::nearest_image(s.cell, outwards));
  return (near.dot(normal) < 0 ? 1 : -1) * (fn * normal + ft * tangent);
}

}  // namespace grainfield::coupling
