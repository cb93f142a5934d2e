// The packings of the matrix: disks, polygons, spheres; in boxes and in periodic cells.
#include <algorithm>
#include <cmath>

#include "dem/random/random.h"
#include "dem/snapshot/images.h"
#include "import_matrix_scene.h"
#include "import_scene.h"
#include "periodic_scene.h"

namespace grainfield::test {
namespace {

using dem::Contact;
using dem::Grain;
using dem::Snapshot;
using dem::Vec3;

// Normals along the lines of centres, points in the middle of the chords and at the feet on walls.
void complete(Snapshot& s) {
  for (Contact& c : s.contacts) {
    const Grain& a = s.grains[static_cast<std::size_t>(c.i)];
    if (c.j < 0) {
      const dem::Wall& wall = s.walls[static_cast<std::size_t>(-1 - c.j)];
      c.normal = -wall.normal;
      c.point = a.position - (a.position - wall.point).dot(wall.normal) * wall.normal;
      continue;
    }
    const Grain& b = s.grains[static_cast<std::size_t>(c.j)];
    const Vec3 branch = dem::second_place(s, c) - a.position;
    const double d = branch.norm();
    c.normal = branch / d;
    c.point = a.position + (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d) * c.normal;
  }
}

Snapshot box_of_spheres(unsigned seed) {
  dem::Random random(seed);
  Snapshot s;
  s.dim = 3;
  constexpr int n = 4;
  for (int k = 0; k < n * n * n; ++k) {
    Grain g;
    g.id = k;
    g.radius = 0.0055 + 0.0004 * random.uniform();
    const auto at = [&](int m) { return 0.01 * m + 0.005 + 2e-4 * random.uniform(); };
    g.position = {at(k % n), at(k / n % n), at(k / (n * n))};
    g.volume = 4.0 / 3 * M_PI * std::pow(g.radius, 3);
    g.mass = 2500 * g.volume;
    s.grains.push_back(g);
  }
  add_wall(s, "floor", {0, 0, 0}, {0, 0, 1});
  add_wall(s, "left", {0, 0, 0}, {1, 0, 0});
  add_wall(s, "right", {0.04, 0, 0}, {-1, 0, 0});
  for (std::int64_t i = 0; i < n * n * n; ++i) {
    const Grain& a = s.grains[static_cast<std::size_t>(i)];
    const auto add = [&](std::int64_t j, const Vec3& from_j) {
      Contact c;
      c.i = i;
      c.j = j;
      c.force = (1 + random.uniform()) * from_j +
                0.2 * Vec3(random.uniform(), random.uniform(), random.uniform());
      s.contacts.push_back(c);
    };
    for (std::int64_t w = 0; w < 3; ++w) {
      const dem::Wall& wall = s.walls[static_cast<std::size_t>(w)];
      if ((a.position - wall.point).dot(wall.normal) < a.radius) add(-1 - w, wall.normal);
    }
    for (std::int64_t j = i + 1; j < n * n * n; ++j) {
      const Grain& b = s.grains[static_cast<std::size_t>(j)];
      const Vec3 branch = b.position - a.position;
      if (branch.norm() < a.radius + b.radius) add(j, -branch.normalized());
    }
  }
  std::sort(s.contacts.begin(), s.contacts.end(), [](const Contact& a, const Contact& b) {
    return std::pair(a.i, a.j) < std::pair(b.i, b.j);
  });
  return s;
}

Motion motion_of(const std::string& name, Snapshot s) {
  s.gravity = {0, s.dim == 2 ? -9.81 : 0, s.dim == 2 ? 0 : -9.81};
  for (Contact& c : s.contacts)  // all push
    if (c.j >= 0) {
      complete(s);
      break;
    }
  Motion out{name, s, s};
  dem::Random random(11);
  const bool periodic = s.cell.is_periodic();
  for (Grain& g : out.after.grains) {
    if (periodic) g.position += s.cell.edges * Vec3(0.7, 0.6, s.cell.periodic[2] ? -1.2 : 0);
    for (Eigen::Index a = 0; a < s.dim; ++a)
      g.position[a] += 1e-5 * (random.uniform() - (a + 1 == s.dim ? 0.5 : 0.5));
  }
  complete(out.before);
  complete(out.after);
  return out;
}

}  // namespace

std::vector<Motion> motions() {
  std::vector<Motion> out;
  out.push_back(motion_of("disks", overlapping_layer(1)));
  Snapshot polygons = overlapping_layer(2);
  for (std::size_t k = 0; k < polygons.grains.size(); k += 3) {
    Grain& g = polygons.grains[k];
    for (int corner = 0; corner < 6; ++corner)
      g.outline.push_back(
          {g.radius * std::cos(corner * M_PI / 3), g.radius * std::sin(corner * M_PI / 3)});
  }
  out.push_back(motion_of("polygons", polygons));
  out.push_back(motion_of("spheres", box_of_spheres(3)));
  out.push_back(motion_of("tilted disks", periodic_packing(2, 4)));
  out.push_back(motion_of("tilted spheres", periodic_packing(3, 5)));
  Snapshot straight = periodic_packing(2, 6);
  straight.contacts.clear();
  straight.cell.edges(0, 1) = 0;
  dem::Random random(7);
  for (std::size_t i = 0; i < straight.grains.size(); ++i) {
    Grain& g = straight.grains[i];
    g.position = dem::wrapped(straight.cell, g.position);
  }
  for (std::size_t i = 0; i < straight.grains.size(); ++i)
    for (std::size_t j = i + 1; j < straight.grains.size(); ++j) {
      Contact c;
      c.i = static_cast<std::int64_t>(i);
      c.j = static_cast<std::int64_t>(j);
      c.image = dem::nearest_image(straight.cell,
                                   straight.grains[j].position - straight.grains[i].position);
      const Vec3 branch = dem::second_place(straight, c) - straight.grains[i].position;
      if (branch.norm() > straight.grains[i].radius + straight.grains[j].radius) continue;
      c.force = -(1 + random.uniform()) * branch.normalized();
      straight.contacts.push_back(c);
    }
  out.push_back(motion_of("straight disks", straight));
  return out;
}

}  // namespace grainfield::test
