#include "averaging_scene.h"

#include <Eigen/QR>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace grainfield::test {

coupling::AverageOptions options(const std::string& method, const std::string& kernel,
                                 double width) {
  coupling::AverageOptions o;
  o.method = method;
  o.kernel = kernel;
  o.width = width;
  o.least_grains = 0;
  return o;
}

dem::Grain disk(std::int64_t id, double x, double y, double radius) {
  dem::Grain g;
  g.id = id;
  g.position = {x, y, 0};
  g.radius = radius;
  g.volume = std::numbers::pi * radius * radius;
  g.mass = 5000 * g.volume;
  g.inertia = g.mass * radius * radius / 2;
  return g;
}

void add_wall(dem::Snapshot& s, const char* name, dem::Vec3 point, dem::Vec3 normal) {
  dem::Wall wall;
  wall.name = name;
  wall.point = point;
  wall.normal = normal;
  s.walls.push_back(wall);
}

void balance_forces(dem::Snapshot& s, const std::vector<dem::Contact>& given) {
  std::vector<int> row(s.grains.size(), -1);
  int rows = 0;
  for (std::size_t g = 0; g < s.grains.size(); ++g)
    if (!s.grains[g].fixed) row[g] = 2 * rows++;
  Eigen::MatrixXd a =
      Eigen::MatrixXd::Zero(2 * rows, 2 * static_cast<Eigen::Index>(s.contacts.size()));
  Eigen::VectorXd b = Eigen::VectorXd::Zero(2 * rows);
  for (std::size_t c = 0; c < s.contacts.size(); ++c)
    for (int d = 0; d < 2; ++d) {
      const auto column = 2 * static_cast<Eigen::Index>(c) + d;
      const int i = row[static_cast<std::size_t>(s.contacts[c].i)];
      if (i >= 0) a(i + d, column) += 1;
      if (s.contacts[c].j < 0) continue;
      const int j = row[static_cast<std::size_t>(s.contacts[c].j)];
      if (j >= 0) a(j + d, column) -= 1;
    }
  for (std::size_t g = 0; g < s.grains.size(); ++g) {
    if (row[g] < 0) continue;
    for (int d = 0; d < 2; ++d) {
      b[row[g] + d] = -s.grains[g].mass * s.gravity[d];
      if (s.grains[g].id == s.loaded_grain) b[row[g] + d] -= s.applied_force[d];
    }
  }
  for (const dem::Contact& contact : given)
    for (int d = 0; d < 2; ++d) b[row[static_cast<std::size_t>(contact.i)] + d] -= contact.force[d];
  const Eigen::VectorXd f = a.completeOrthogonalDecomposition().solve(b);
  for (std::size_t c = 0; c < s.contacts.size(); ++c) {
    dem::Contact& contact = s.contacts[c];
    contact.force = {f[2 * static_cast<Eigen::Index>(c)], f[2 * static_cast<Eigen::Index>(c) + 1],
                     0};
    contact.normal_force = -contact.force.dot(contact.normal);
  }
}

dem::Snapshot layer(unsigned seed, int columns, int rows, bool rough, double load) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double d = 0.01;
  dem::Snapshot s;
  s.gravity = {0, -9.81, 0};
  if (!rough) add_wall(s, "floor", {0, 0, 0}, {0, 1, 0});
  add_wall(s, "left", {0, 0, 0}, {1, 0, 0});
  add_wall(s, "right", {columns * d, 0, 0}, {-1, 0, 0});
  const auto wall = [&](const std::string& name) {
    for (std::size_t w = 0; w < s.walls.size(); ++w)
      if (s.walls[w].name == name) return -1 - static_cast<std::int64_t>(w);
    return std::int64_t{0};
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      dem::Grain g =
          disk(c + columns * r, (c + 0.5 + 0.15 * uniform(random)) * d,
               (r + 0.5 + 0.15 * uniform(random)) * d, d * (0.45 + 0.1 * uniform(random)));
      g.fixed = rough && r == 0;
      if (g.fixed) g.position.y() = 0.5 * d;
      s.grains.push_back(g);
    }
  if (load > 0) {
    s.loaded_grain = columns * (rows - 1) + columns / 2;
    s.applied_force = {0, -load, 0};
  }
  const auto n = static_cast<std::int64_t>(s.grains.size());
  for (std::int64_t i = 0; i < n; ++i) {
    const dem::Grain& gi = s.grains[static_cast<std::size_t>(i)];
    const auto touch = [&](std::int64_t j, dem::Vec3 point) {
      dem::Contact contact;
      contact.i = i;
      contact.j = j;
      contact.point = point;
      contact.normal = (point - gi.position).normalized();
      s.contacts.push_back(contact);
    };
    const int c = static_cast<int>(i % columns), r = static_cast<int>(i / columns);
    const double x = gi.position.x(), y = gi.position.y();
    if (!gi.fixed && c == columns - 1) touch(wall("right"), {columns * d, y, 0});
    if (!gi.fixed && c == 0) touch(wall("left"), {0, y, 0});
    if (!rough && r == 0) touch(wall("floor"), {x, 0, 0});
    for (std::int64_t j = i + 1; j < n; ++j) {
      const dem::Grain& gj = s.grains[static_cast<std::size_t>(j)];
      if (gi.fixed && gj.fixed) continue;
      const dem::Vec3 branch = gj.position - gi.position;
      if (branch.norm() < 1.5 * d)
        touch(j, gi.position + branch * gi.radius / (gi.radius + gj.radius));
    }
  }
  balance_forces(s);
  return s;
}

double weight(const dem::Snapshot& s) {
  double sum = 0;
  for (const dem::Grain& g : s.grains)
    if (!g.fixed) sum -= g.mass * s.gravity.y();
  return sum;
}

}  // namespace grainfield::test
