// A snapshot with all that one can hold, and its bits.
#pragma once
#include <string>

#include "dem/checkpoint/checkpoint.h"
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
    g.volume = 3 * g.radius * g.radius;
    g.fixed = k % 5 == 0;
    s.grains.push_back(g);
  }
  s.grains[3].radius = 1;
  s.grains[4].outline = {{-1, -1}, {1, -1}, {0, 1}};
  s.walls.push_back({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
  s.walls.push_back({"left", {-1, 0, 0}, {1, 0, 0}, 0});
  Contact c;
  c.i = 3;
  c.j = 7;
  c.force = Vec3(1, 2, 0);
  c.normal = Vec3(-0.6, -0.8, 0);
  c.normal_force = 2.2;
  c.sliding = true;
  s.contacts = {c};
  c.j = -2;
  c.point = Vec3(-1, 4, 0);
  c.normal = Vec3(-1, 0, 0);
  c.normal_force = 1;
  s.contacts.push_back(c);
  s.walls[1].force = Vec3(-1, -2, 0);
  s.walls[1].torque = Vec3(0, 0, 4);
  return s;
}

/// With a value of its own wherever there is room for one, nothing as by default.
inline Snapshot full_snapshot(int dim) {
  Random random(11);
  const auto some = [&] { return 0.1 + random.uniform(); };
  const auto vector = [&] { return Vec3(some(), some(), dim == 2 ? 0 : some()); };
  Snapshot s = small_snapshot();
  s.dim = dim;
  s.gravity = vector();
  s.applied_force = vector();
  const char* materials[] = {"glass", "", "steel"};
  for (Grain& g : s.grains) {
    g.position = vector();
    g.velocity = vector();
    for (double* v : {&g.angle, &g.spin, &g.radius, &g.mass, &g.inertia, &g.volume}) *v = some();
    if (g.id == 3) g.radius += 1;  // the image of its contact is edges away
    g.material = materials[g.id % 3];
    g.rotates = g.id % 4 != 0;
    g.image = {static_cast<int>(g.id) - 1, 0, 0};
    if (dim == 2) continue;
    g.outline.clear();
    Eigen::Vector4d q(some(), -some(), some(), some());
    q.normalize();
    g.orientation = {q[0], q[1], q[2], q[3]};
    g.angular_velocity = vector();
    g.moments = vector();
    if (g.id % 2 == 0) {
      g.axes = vector();
      g.exponents = {some(), some()};
    }
  }
  for (Contact& c : s.contacts) {
    for (Vec3* v : {&c.point, &c.normal, &c.force}) *v = vector();
    c.normal.normalize();
    c.normal_force = -c.force.dot(c.normal);
    for (double* v : {&c.tangential_force, &c.spring, &c.friction}) *v = some();
    if (dim == 3) c.spring_vector = vector();
    if (c.j >= 0) c.image = {-1, 2, 0};
    c.rolling_spring = vector();
    c.twisting_spring = some();
  }
  Wall cone{"hopper", vector(), {0, 1, 0}, 0.3};
  cone.shape = "cone";
  for (double* v : {&cone.radius, &cone.end_radius, &cone.length}) *v = some();
  cone.inside = false;
  cone.material = "steel";
  for (Vec3* v : {&cone.velocity, &cone.angular_velocity, &cone.force, &cone.torque}) *v = vector();
  Wall mesh{"mesh", vector(), {0, 1, 0}, 0.3};
  mesh.shape = "mesh";
  for (int k = 0; k < 3; ++k) mesh.triangles.push_back({vector(), vector(), vector()});
  s.walls.push_back(cone);
  s.walls.push_back(mesh);
  s.cell.periodic = {true, true, false};
  s.cell.low = vector();
  s.cell.edges.col(0) = Vec3(2, 0, 0);
  s.cell.edges.col(1) = Vec3(0.5, 3, 0);
  s.cell.velocity_gradient(0, 1) = 0.25;
  return s;
}

/// each(value) for all that a snapshot holds: numbers, vectors and texts.
template <class Each>
void visit_values(const Snapshot& s, Each each) {
  const auto all = [&](const auto&... values) { (each(values), ...); };
  all(s.dim, s.time, s.gravity, s.loaded_grain, s.applied_force, s.cell.low);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto k = static_cast<Eigen::Index>(a);
    all(s.cell.periodic[a], Vec3(s.cell.edges.col(k)), Vec3(s.cell.velocity_gradient.col(k)));
  }
  all(s.also_loaded.size(), s.grains.size(), s.contacts.size(), s.walls.size(),
      s.attributes.size());
  for (const std::int64_t id : s.also_loaded) all(id);
  for (const Grain& g : s.grains) {
    all(g.id, g.position, g.velocity, g.angle, g.spin, g.radius, g.mass, g.inertia, g.volume,
        g.fixed, g.orientation, g.angular_velocity, g.moments, g.material, g.rotates, g.image,
        g.axes, g.exponents, g.outline.size());
    for (const auto& corner : g.outline) all(corner);
  }
  for (const Contact& c : s.contacts) {
    all(c.i, c.j, c.point, c.normal, c.force, c.normal_force, c.tangential_force, c.spring,
        c.friction, c.sliding, c.spring_vector, c.image, c.rolling_spring, c.twisting_spring);
  }
  for (const Wall& w : s.walls) {
    all(w.name, w.point, w.normal, w.friction, w.shape, w.radius, w.end_radius, w.length, w.inside,
        w.material, w.velocity, w.angular_velocity, w.force, w.torque, w.triangles.size());
    for (const auto& triangle : w.triangles)
      for (const Vec3& corner : triangle) all(corner);
  }
  for (const auto& [key, value] : s.attributes) all(key, value);
}

inline void put_bits(const Snapshot& s, CheckpointWriter& w) {
  visit_values(s, [&](const auto& value) { w.put(value); });
}

/// All snapshots of a file with their names.
inline std::string bits_of_file(const std::string& file) {
  CheckpointWriter w;
  for (const std::string& group : list_snapshots(file)) {
    w.put(group);
    put_bits(read_snapshot(file, group), w);
  }
  return w.bytes();
}

}  // namespace grainfield::dem
