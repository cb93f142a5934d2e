#include "dem/snapshot/wall_forces.h"

#include <Eigen/Geometry>
#include <cstdint>

namespace grainfield::dem {

void set_wall_forces(Snapshot& s) {
  const auto grains = static_cast<std::int64_t>(s.grains.size());
  const auto walls = static_cast<std::int64_t>(s.walls.size());
  for (Wall& wall : s.walls) wall.force = wall.torque = Vec3(0, 0, 0);
  for (const Contact& c : s.contacts) {
    if (c.j >= 0 || -1 - c.j >= walls || c.i < 0 || c.i >= grains) continue;
    Wall& wall = s.walls[static_cast<std::size_t>(-1 - c.j)];
    wall.force -= c.force;
    wall.torque -= (c.point - wall.point).cross(c.force);
    const double radius = s.grains[static_cast<std::size_t>(c.i)].radius;
    wall.torque -= radius * c.normal.cross(c.rolling_spring) + c.twisting_spring * c.normal;
  }
}

}  // namespace grainfield::dem
