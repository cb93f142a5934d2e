// Meshes for tests of walls.
#pragma once
#include <cmath>
#include <numbers>

#include "dem/walls/mesh.h"

namespace grainfield::dem {

/// Two triangles a side, counter-clockwise seen from outside or from inside.
inline Triangles box_mesh(const Vec3& low, const Vec3& high, bool inside) {
  Triangles out;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool top : {false, true}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      Vec3 a = top ? high : low;
      const auto at = [&](bool high_u, bool high_v) {
        Vec3 p = a;
        p[u] = high_u ? high[u] : low[u];
        p[v] = high_v ? high[v] : low[v];
        return p;
      };
      std::array<Vec3, 4> c{at(false, false), at(true, false), at(true, true), at(false, true)};
      if (top == inside) std::swap(c[1], c[3]);
      out.push_back({c[0], c[1], c[2]});
      out.push_back({c[0], c[2], c[3]});
    }
  }
  return out;
}

/// A closed drum about z seen from inside, of this many sides.
inline Triangles drum_mesh(double radius, double length, int sides) {
  Triangles out;
  const auto rim = [&](int k, double z) {
    const double angle = 2 * std::numbers::pi * (k % sides) / sides;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (int k = 0; k < sides; ++k) {
    const Vec3 a = rim(k, 0), b = rim(k + 1, 0), c = rim(k + 1, length), d = rim(k, length);
    out.push_back({a, c, b});
    out.push_back({a, d, c});
    out.push_back({Vec3(0, 0, 0), a, b});
    out.push_back({Vec3(0, 0, length), c, d});
  }
  return out;
}

}  // namespace grainfield::dem
