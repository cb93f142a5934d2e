// The planes of a box that holds grains.
#pragma once
#include <string>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// In 2D "left", "right", "floor", "lid"; in 3D also "front" (low y) and "back", with the floor at
/// the low z. From `low` to `high`, m.
inline std::vector<Wall> box_walls(const Vec3& low, const Vec3& high, double friction, int dim) {
  const auto plane = [&](const char* name, const Vec3& point, int axis, double sign) {
    Wall wall;
    wall.name = name;
    wall.point = point;
    wall.normal = sign * Vec3::Unit(axis);
    wall.friction = friction;
    return wall;
  };
  std::vector<Wall> walls{plane("left", low, 0, 1), plane("right", high, 0, -1)};
  if (dim == 3) {
    walls.push_back(plane("front", low, 1, 1));
    walls.push_back(plane("back", high, 1, -1));
  }
  walls.push_back(plane("floor", low, dim - 1, 1));
  walls.push_back(plane("lid", high, dim - 1, -1));
  return walls;
}

}  // namespace grainfield::dem
