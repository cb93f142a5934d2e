// An imported packing against the program that made it: stress, balance, weight, normals.
#include <algorithm>
#include <cmath>

#include "coupling/import/import.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

// A contact point farther than this many radii from its wall's plane is on another wall.
constexpr double kOddNormal = 0.5;  // cosine of the angle to the line of centres
constexpr double kOffWall = 2;
constexpr double kPulling = 1e-3;  // of the mean force: a pull below it is rounding
// Shares of the Coulomb limit and the whole force: digits that files round away, and slow motion.
constexpr double kBeyondFriction = 1e-3, kBeyondForce = 1e-6;

void check_coulomb_limit(const dem::Contact& c, PackingCheck& check) {
  if (!std::isfinite(c.friction)) {
    check.unknown_friction += c.j >= 0;
    check.steep += c.j >= 0 && std::fabs(c.tangential_force) >
                                   (1 + kBeyondFriction) * std::fabs(c.normal_force);
    return;
  }
  ++check.known_friction;
  const double most = c.friction * std::max(c.normal_force, 0.0) * (1 + kBeyondFriction);
  check.beyond_friction +=
      !c.sliding && std::fabs(c.tangential_force) > most + kBeyondForce * c.force.norm();
}

// Counts a contact of two disks or spheres, whose normal is along the line of centres, or of
// polygons, whose normal is less than a right angle off it.
void check_contact_normal(const dem::Snapshot& s, const dem::Contact& c, PackingCheck& check) {
  const dem::Grain& i = s.grains[static_cast<std::size_t>(c.i)];
  const dem::Grain& j = s.grains[static_cast<std::size_t>(c.j)];
  const auto round = [](const dem::Grain& g) { return g.outline.empty() && g.axes.isZero(); };
  if (!i.outline.empty() || !j.outline.empty()) {
    ++check.polygon_pairs;
    if (c.normal.dot(dem::second_place(s, c) - i.position) >= 0) return;
    if (check.turned_normals++ > 0) return;
    check.turned_i = i.id;
    check.turned_j = j.id;
    return;
  }
  if (!round(i) || !round(j)) return;
  ++check.round_pairs;
  const dem::Vec3 branch = dem::second_place(s, c) - i.position;
  if (c.normal.dot(branch) >= kOddNormal * c.normal.norm() * branch.norm()) return;
  if (check.odd_normals++ > 0) return;
  check.odd_i = i.id;
  check.odd_j = j.id;
}

// From grain i outwards through the contact: along the centres of round grains, whatever the file's
// normal is.
dem::Vec3 outwards(const dem::Snapshot& s, const dem::Contact& c) {
  const dem::Grain& i = s.grains[static_cast<std::size_t>(c.i)];
  const auto round = [](const dem::Grain& g) { return g.outline.empty() && g.axes.isZero(); };
  if (c.j < 0 || !round(i) || !round(s.grains[static_cast<std::size_t>(c.j)])) return c.normal;
  return dem::second_place(s, c) - i.position;
}

// Counts the contacts that pull, as they are and with one component of all forces turned.
void count_pulling(const dem::Snapshot& s, double mean_force, PackingCheck& check) {
  for (const dem::Contact& c : s.contacts) {
    const dem::Vec3 normal = outwards(s, c).normalized();
    const double along = c.force.dot(normal), least = kPulling * mean_force;
    const bool bears = std::fabs(along) > least, pulls = along > least;
    check.bearing += bears;
    check.pulling += pulls;
    check.bearing_walls += bears && c.j < 0;
    check.pulling_walls += pulls && c.j < 0;
    for (std::size_t k = 0; k < kAxesChanges.size(); ++k) {
      const auto& [text, from, sign] = kAxesChanges[k];
      // In the plane nothing is exchanged with z.
      const bool flat = s.dim == 2 && from[2] != 2;
      double changed = 0;
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        changed += sign[static_cast<std::size_t>(axis)] *
                   c.force[from[static_cast<std::size_t>(axis)]] * normal[axis];
      check.pulling_changed[k] += changed > least;
      check.pushing_changed[k] += !flat && changed < -least;
    }
  }
}

}  // namespace

PackingCheck check_packing(const dem::Snapshot& s) {
  PackingCheck check;
  std::vector<dem::Vec3> resultant(s.grains.size(), dem::Vec3::Zero());
  std::vector<bool> touched(s.grains.size(), false);
  double force = 0;
  dem::Vec3 support = dem::Vec3::Zero(), weight = dem::Vec3::Zero();
  const auto free = [&](std::int64_t g) {
    return g >= 0 && !s.grains[static_cast<std::size_t>(g)].fixed;
  };
  const auto add = [&](Eigen::Matrix3d& sum, std::int64_t grain, const dem::Vec3& arm,
                       const dem::Vec3& f) {
    const auto g = static_cast<std::size_t>(grain);
    sum += f * arm.transpose();
    resultant[g] += f;
    touched[g] = true;
  };
  for (const dem::Contact& c : s.contacts) {
    Eigen::Matrix3d& sum = c.j >= 0 ? check.pairs : check.walls;
    add(sum, c.i, c.point - s.grains[static_cast<std::size_t>(c.i)].position, c.force);
    if (c.j >= 0) add(sum, c.j, c.point - dem::second_place(s, c), -c.force);
    if (c.j >= 0) check_contact_normal(s, c, check);
    check_coulomb_limit(c, check);
    if (c.j >= 0 && !c.force.isZero(0)) {
      ++check.loaded_pairs;
      check.pairs_along += std::fabs(c.tangential_force) <= kBeyondFriction * c.force.norm();
    }
    force += c.force.norm() / static_cast<double>(s.contacts.size());
    if (free(c.i) && !free(c.j)) support += c.force;
    if (c.j < 0) {
      const dem::Wall& wall = s.walls[static_cast<std::size_t>(-1 - c.j)];
      ++check.wall_contacts;
      if (wall.shape != "plane") continue;
      const double off = std::abs((c.point - wall.point).dot(wall.normal));
      check.off_wall_contacts += off > kOffWall * s.grains[static_cast<std::size_t>(c.i)].radius;
    }
    if (!free(c.i) && free(c.j)) support -= c.force;
  }
  count_pulling(s, force, check);
  const dem::Vec3 up = -s.gravity.normalized();  // zero without gravity
  double total = 0, squares = 0;
  int count = 0;
  for (std::size_t g = 0; g < s.grains.size(); ++g) {
    if (s.grains[g].fixed) continue;
    dem::Vec3 load = s.grains[g].mass * s.gravity;
    if (s.grains[g].id == s.loaded_grain) load += s.applied_force;
    weight += load;
    const dem::Vec3 f = resultant[g] + load;
    squares += std::pow(f.dot(up), 2);
    if (!touched[g]) continue;
    total += f.norm();
    ++count;
  }
  if (force > 0 && count > 0) check.unbalanced_force_ratio = total / count / force;
  const double g = s.gravity.norm();
  if (g > 0 && !s.contacts.empty()) {
    const dem::Vec3 down = s.gravity / g;
    check.pairs_along_gravity = down.dot(check.pairs * down);
    check.walls_along_gravity = down.dot(check.walls * down);
    check.weight = weight.dot(down);
    check.across = support - support.dot(down) * down;
    // 0 - 0 is +0 where -0 would be printed.
    if (weight.dot(down) > 0) {
      check.support_ratio = (0 - support.dot(down)) / weight.dot(down);
      check.support_error = std::sqrt(squares) / weight.dot(down);
    }
  }
  return check;
}

}  // namespace grainfield::coupling
