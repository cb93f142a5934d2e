#include "coupling/studies/sample/simulation/drop.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coupling/studies/sample/simulation/grains.h"
#include "dem/shapes/common_normal.h"

namespace grainfield::dem {
namespace {

// Spheres are given up after this many failures in a row for each that would cover the lid.
constexpr double kDropTries = 50;
// Fitted spheres miss the grain that stops them by this share of their radius at most.
constexpr double kFit = 1e-6;
// Densities within this share are the same: volumes are sums of rounded numbers.
constexpr double kSameDensity = 1e-9;

double& lid_of(Snapshot& s) {
  for (Wall& wall : s.walls) {
    if (wall.name == "lid") return wall.point.z();
  }
  throw std::logic_error("a dropped sample has no lid");
}

// Edges of the floor along x and y, m.
std::array<double, 2> base_of(const Snapshot& s) {
  std::array<double, 2> out{};
  for (const Wall& wall : s.walls) {
    if (wall.name == "right") out[0] = wall.point.x();
    if (wall.name == "back") out[1] = wall.point.y();
  }
  return out;
}

// Takes the motion of grains and walls away, and gravity.
void stop(Snapshot& s) {
  s.gravity.setZero();
  for (Grain& g : s.grains) {
    g.velocity.setZero();
    g.angular_velocity.setZero();
    g.spin = 0;
  }
  for (Wall& wall : s.walls) wall.velocity.setZero();
}

// The largest radius up to `most` that is free, to kFit of itself; `least` is. Spheres that touch
// the lid in one point lie in each other, so those below a free radius are free.
template <class Free>
double largest_free(double least, double most, const Free& is_free) {
  if (is_free(most)) return most;
  double low = least, high = most;
  while (high - low > kFit * low) {
    const double middle = 0.5 * (low + high);
    (is_free(middle) ? low : high) = middle;
  }
  return low;
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
  stop(s);
  double top = 0, solid = 0;
  for (const Grain& g : s.grains) {
    top = std::max(top, g.position.z() + rise_of(g));
    solid += g.volume;
  }
  const auto [width, depth] = base_of(s);
  lid_of(s) = out.height = top;
  const auto [least, mean, most] = gap_radii(plan);
  const long tries = std::lround(kDropTries * width * depth / (std::numbers::pi * mean * mean));
  std::vector<Grain> near;  // those that a sphere at the lid can meet
  for (const Grain& g : s.grains) {
    if (g.position.z() + g.radius > top - 2 * most) near.push_back(g);
  }
  const bool fitted = plan.gap == "fitted";
  // Below the lid at (x, y): whether it meets no grain.
  const auto is_free = [&](double x, double y, double r) {
    Grain sphere = sphere_of(r, density, plan.shape == "superellipsoid");
    sphere.position = {x, y, top - r};
    return std::none_of(near.begin(), near.end(),
                        [&](const Grain& g) { return overlap(g, sphere); });
  };
  for (long failures = 0; failures < tries;) {
    double r = fitted ? least : draw_gap_radius(plan, random);
    const double x = random.uniform(r, width - r), y = random.uniform(r, depth - r);
    if (!is_free(x, y, r)) {
      ++failures;
      continue;
    }
    failures = 0;
    if (fitted) {
      const double room = std::min({x, width - x, y, depth - y, most});
      r = largest_free(r, room, [&](double radius) { return is_free(x, y, radius); });
    }
    Grain sphere = sphere_of(r, density, plan.shape == "superellipsoid");
    sphere.position = {x, y, top - r};
    sphere.id = static_cast<std::int64_t>(s.grains.size());
    solid += sphere.volume;
    s.grains.push_back(sphere);
    near.push_back(sphere);
    ++out.spheres;
  }
  out.solid_share = solid / (width * depth * top);
  return out;
}

FilledBox filled_box(const Snapshot& state, const SamplePlan& plan, double density) {
  FilledBox out;
  out.snapshot = state;
  Snapshot& s = out.snapshot;
  stop(s);
  s.contacts.clear();
  const auto count = static_cast<int>(s.grains.size());
  if (count < plan.grains) {
    throw std::invalid_argument(fmt::format(
        "sample.grains: found {}, allowed: up to the {} grains of the state in grains.files",
        plan.grains, count));
  }
  double mass = 0, solid = 0;
  for (const Grain& g : s.grains) {
    if (is_superellipsoid(g) != (plan.shape == "superellipsoid")) {
      throw std::invalid_argument(fmt::format(
          "sample.shape: found \"{}\", allowed: the shape of the grains in grains.files",
          plan.shape));
    }
    mass += g.mass;
    solid += g.volume;
  }
  if (std::fabs(mass / solid / density - 1) > kSameDensity) {
    throw std::invalid_argument(
        fmt::format("material.density: found {:g}, allowed: {:.9g}, that of the grains in "
                    "grains.files",
                    density, mass / solid));
  }
  out.spheres = count - plan.grains;
  out.height = lid_of(s);
  const auto [width, depth] = base_of(s);
  out.solid_share = solid / (width * depth * out.height);
  return out;
}

}  // namespace grainfield::dem
