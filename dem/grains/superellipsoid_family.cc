#include "dem/grains/superellipsoid_family.h"

#include <cmath>
#include <numbers>

#include "dem/shapes/superellipsoid.h"
#include "dem/space/elementary.h"

namespace grainfield::dem {
namespace {

double volume_of_ball(double radius) {
  return 4.0 / 3 * std::numbers::pi * radius * radius * radius;
}

}  // namespace

// The orientation is uniform (Shoemake 1992).
ShapedGrain draw_superellipsoid(const SuperellipsoidFamily& f, double size, Random& random) {
  ShapedGrain out;
  for (double& r : out.axes) r = size * random.uniform(f.axis_min, f.axis_max);
  for (double& e : out.exponents) e = random.uniform(f.exponent_min, f.exponent_max);
  const Solid<3> solid = solid_of(superellipsoid(out.axes, out.exponents));
  out.radius = solid.radius;
  out.area = solid.volume;
  const double part = random.uniform(), rest = std::sqrt(1 - part), root = std::sqrt(part);
  const Rotation a = rotation_of(2 * std::numbers::pi * random.uniform());
  const Rotation b = rotation_of(2 * std::numbers::pi * random.uniform());
  out.orientation = {rest * a.sine, rest * a.cosine, root * b.sine, root * b.cosine};
  return out;
}

// The axes are independent, the rest is a mean over both exponents (midpoints).
double mean_volume(const SuperellipsoidFamily& f, double size) {
  constexpr int kPoints = 8;
  const double axis = 0.5 * (f.axis_min + f.axis_max) * size;
  const auto at = [&](int k) {
    return f.exponent_min + (f.exponent_max - f.exponent_min) * (k + 0.5) / kPoints;
  };
  double sum = 0;
  for (int k = 0; k < kPoints; ++k) {
    for (int l = 0; l < kPoints; ++l) {
      sum += solid_of(superellipsoid({axis, axis, axis}, {at(k), at(l)})).volume;
    }
  }
  return sum / (kPoints * kPoints);
}

// The exponents' ends give the extremes: edges are nearest, corners of boxes farthest.
FamilyRadii radii_of(const SuperellipsoidFamily& f, double size) {
  const double low = size * f.axis_min, high = size * f.axis_max;
  const double most = f.exponent_max, least = f.exponent_min;
  return {nearest_of(superellipsoid({low, low, low}, {most, most})),
          cube_root(mean_volume(f, size) / (4.0 / 3 * std::numbers::pi)),
          farthest_of(superellipsoid({high, high, high}, {least, least}))};
}

double share_of_balls(const SuperellipsoidFamily& f) {
  constexpr int kDraws = 500;
  Random random(1);
  double solid = 0, balls = 0;
  for (int k = 0; k < kDraws; ++k) {
    const ShapedGrain grain = draw_superellipsoid(f, 1, random);
    solid += grain.area;
    balls += volume_of_ball(grain.radius);
  }
  return solid / balls;
}

GrainExtremes extremes_of_superellipsoids(const std::vector<ShapedGrain>& grains, double density) {
  GrainExtremes extremes;
  for (const ShapedGrain& grain : grains) {
    const FeltMass felt = felt_mass(superellipsoid(grain.axes, grain.exponents), density);
    // The stiffness of Hertz' laws goes by the radius.
    const bool first = extremes.least_radius == 0;
    if (first || felt.mass * extremes.least_radius < extremes.least_mass * felt.radius) {
      extremes.least_mass = felt.mass;
      extremes.least_radius = felt.radius;
    }
  }
  return extremes;
}

}  // namespace grainfield::dem
