// A snapshot with all that one can hold, and its bits.
#pragma once
#include <string>

#include "dem/image/image.h"
#include "dem/random/random.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

inline Snapshot small_snapshot() {
  Random random(5);
  Snapshot s;
  s.time = 1.25;
  s.gravity = Vec3(0, -9.81, 0);
  s.loaded_grain = 3;
  s.applied_force = Vec3(0, -30, 0);
  s.attributes = {{"law", "linear"}, {"seed", "42"}};
  for (int k = 0; k < 20; ++k) {
    Grain g;
    g.id = k;
    g.position = Vec3(random.uniform(), random.uniform(), 0);
    g.angle = random.uniform();
    g.radius = random.uniform();
    g.mass = random.uniform();
    g.fixed = k % 5 == 0;
    s.grains.push_back(g);
  }
  s.grains[4].outline = {{-1, -1}, {1, -1}, {0, 1}};
  s.walls.push_back({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
  s.walls.push_back({"left", {-1, 0, 0}, {1, 0, 0}, 0});
  Contact c;
  c.i = 3;
  c.j = 7;
  c.force = Vec3(1, 2, 0);
  c.normal_force = 3;
  c.sliding = true;
  s.contacts = {c};
  c.j = -2;
  s.contacts.push_back(c);
  return s;
}

inline void put_bits(const Snapshot& s, ImageWriter& w) {
  const auto put = [&](const Vec3& v) {
    for (int k = 0; k < 3; ++k) w.put(v[k]);
  };
  w.put(s.dim);
  w.put(s.time);
  put(s.gravity);
  w.put(s.loaded_grain);
  put(s.applied_force);
  for (const Grain& g : s.grains) {
    w.put(g.id);
    put(g.position);
    put(g.velocity);
    for (const double v : {g.angle, g.spin, g.radius, g.mass, g.inertia, g.volume}) w.put(v);
    w.put(g.fixed);
    for (const auto& corner : g.outline) w.put(corner);
  }
  for (const Contact& c : s.contacts) {
    w.put(c.i);
    w.put(c.j);
    for (const Vec3& v : {c.point, c.normal, c.force}) put(v);
    for (const double v : {c.normal_force, c.tangential_force, c.spring, c.friction}) w.put(v);
    w.put(c.sliding);
  }
  for (const Wall& wall : s.walls) {
    w.put(wall.name);
    put(wall.point);
    put(wall.normal);
    w.put(wall.friction);
  }
  for (const auto& [key, value] : s.attributes) {
    w.put(key);
    w.put(value);
  }
}

/// All snapshots of a file with their names.
inline std::string bits_of_file(const std::string& file) {
  ImageWriter w;
  for (const std::string& group : list_snapshots(file)) {
    w.put(group);
    put_bits(read_snapshot(file, group), w);
  }
  return w.bytes();
}

}  // namespace grainfield::dem
