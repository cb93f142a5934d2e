#include "dem/study/sample_drop.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dem/shapes/common_normal.h"
#include "dem/study/sample_grains.h"

namespace grainfield::dem {
namespace {

// Spheres are given up after this many failures in a row for each that would cover the lid.
constexpr double kDropTries = 50;

double& lid_of(Snapshot& s) {
  for (Wall& wall : s.walls) {
    if (wall.name == "lid") return wall.point.z();
  }
  throw std::logic_error("a dropped sample has no lid");
}

bool is_superellipsoid(const Grain& g) { return g.axes.maxCoeff() > 0; }

Eigen::Matrix3d turn_of(const Grain& g) {
  const auto& q = g.orientation;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

Superellipsoid body_of(const Grain& g) {
  return superellipsoid({g.axes[0], g.axes[1], g.axes[2]}, g.exponents);
}

// Height of its highest point above its centre.
double rise_of(const Grain& g) {
  if (!is_superellipsoid(g)) return g.radius;
  return height_of(body_of(g), turn_of(g).transpose() * Eigen::Vector3d::UnitZ());
}

bool overlap(const Grain& g, const Grain& sphere) {
  const Eigen::Vector3d across = sphere.position - g.position;
  if (across.norm() >= g.radius + sphere.radius) return false;
  if (!is_superellipsoid(g)) return true;
  const Superellipsoid first = body_of(g), second = body_of(sphere);
  const Eigen::Matrix3d turn = turn_of(g), upright = Eigen::Matrix3d::Identity();
  PairNormal memory;
  CommonNormal found;
  return common_normal({first, turn, farthest_of(first), nearest_of(first)},
                       {second, upright, sphere.radius, sphere.radius}, across, memory, found);
}

Grain sphere_of(double radius, double density, bool as_superellipsoid) {
  Grain g;
  g.radius = radius;
  g.volume = 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  g.mass = density * g.volume;
  g.inertia = 0.4 * g.mass * radius * radius;
  g.moments = Eigen::Vector3d::Constant(g.inertia);
  if (as_superellipsoid) {
    g.axes = Eigen::Vector3d::Constant(radius);
    g.exponents = {1, 1};
  }
  return g;
}

}  // namespace

SamplePlan as_filled(const SamplePlan& plan) {
  SamplePlan out = plan;
  if (!is_dropped(plan)) return out;
  out.filling = "placed";
  out.start_fraction = plan.base_fraction;
  return out;
}

FilledBox put_lid_on(const Snapshot& bed, const SamplePlan& plan, double density, Random& random) {
  FilledBox out;
  out.snapshot = bed;
  Snapshot& s = out.snapshot;
  s.gravity.setZero();
  double top = 0, width = 0, depth = 0, solid = 0;
  for (Grain& g : s.grains) {
    g.velocity.setZero();
    g.angular_velocity.setZero();
    g.spin = 0;
    top = std::max(top, g.position.z() + rise_of(g));
    solid += g.volume;
  }
  for (Wall& wall : s.walls) {
    wall.velocity.setZero();
    if (wall.name == "right") width = wall.point.x();
    if (wall.name == "back") depth = wall.point.y();
  }
  lid_of(s) = out.height = top;
  const auto [least, mean, most] = gap_radii(plan);
  const long tries = std::lround(kDropTries * width * depth / (std::numbers::pi * mean * mean));
  std::vector<Grain> near;  // those that a sphere at the lid can meet
  for (const Grain& g : s.grains) {
    if (g.position.z() + g.radius > top - 2 * most) near.push_back(g);
  }
  for (long failures = 0; failures < tries;) {
    const double r = draw_gap_radius(plan, random);
    Grain sphere = sphere_of(r, density, plan.shape == "superellipsoid");
    const double x = random.uniform(r, width - r), y = random.uniform(r, depth - r);
    sphere.position = {x, y, top - r};
    const bool meets =
        std::any_of(near.begin(), near.end(), [&](const Grain& g) { return overlap(g, sphere); });
    if (meets) {
      ++failures;
      continue;
    }
    failures = 0;
    sphere.id = static_cast<std::int64_t>(s.grains.size());
    solid += sphere.volume;
    s.grains.push_back(sphere);
    near.push_back(sphere);
    ++out.spheres;
  }
  out.solid_share = solid / (width * depth * top);
  return out;
}

}  // namespace grainfield::dem
