// Small packings for tests of derived quantities.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "averaging_scene.h"
#include "tests/refusal.h"

namespace grainfield::test {

// Contact of two grains with a force of size f that presses them together.
inline void press(dem::Snapshot& s, std::int64_t i, std::int64_t j, double f) {
  const auto at = [&](std::int64_t k) -> const dem::Grain& {
    return s.grains[static_cast<std::size_t>(k)];
  };
  dem::Contact c;
  c.i = i;
  c.j = j;
  c.normal = (at(j).position - at(i).position).normalized();
  c.point = (at(i).position + at(j).position) / 2;
  c.force = -f * c.normal;
  c.normal_force = f;
  s.contacts.push_back(c);
}

// The plane turned about the origin.
inline dem::Snapshot turned(dem::Snapshot s, double angle) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  s.gravity = r * s.gravity;
  s.applied_force = r * s.applied_force;
  for (dem::Grain& g : s.grains) {
    g.position = r * g.position;
    g.angle += angle;
  }
  for (dem::Wall& w : s.walls) {
    w.point = r * w.point;
    w.normal = r * w.normal;
  }
  for (dem::Contact& c : s.contacts) {
    c.point = r * c.point;
    c.normal = r * c.normal;
    c.force = r * c.force;
  }
  return s;
}

// Columns of disks one above the other between floor and lid, column c pressed by load[c].
inline dem::Snapshot columns(const std::vector<double>& load, int rows) {
  dem::Snapshot s;
  add_wall(s, "floor", {0, -0.5, 0}, {0, 1, 0});
  add_wall(s, "lid", {0, rows - 0.5, 0}, {0, -1, 0});
  for (std::size_t c = 0; c < load.size(); ++c)
    for (int r = 0; r < rows; ++r) {
      const auto id = static_cast<std::int64_t>(s.grains.size());
      s.grains.push_back(disk(id, static_cast<double>(c), r, 0.5));
      if (r > 0) press(s, id - 1, id, load[c]);
      for (const int w : {0, 1}) {
        if (r != (w == 0 ? 0 : rows - 1)) continue;
        dem::Contact contact;
        contact.i = id;
        contact.j = -1 - w;
        contact.normal = {0, w == 0 ? -1.0 : 1.0, 0};
        contact.point = s.grains.back().position + 0.5 * contact.normal;
        contact.force = -load[c] * contact.normal;
        contact.normal_force = load[c];
        s.contacts.push_back(contact);
      }
    }
  return s;
}

}  // namespace grainfield::test
