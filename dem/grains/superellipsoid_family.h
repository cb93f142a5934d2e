// Superellipsoids drawn from a seed.
#pragma once
#include <tuple>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/grains/grain_family.h"
#include "dem/random/random.h"

namespace grainfield::dem {

/// Semi-axes over the size, each uniform between both ends, and exponents likewise.
struct SuperellipsoidFamily {
  double axis_min = 0.7, axis_max = 1.3;
  double exponent_min = 0.7, exponent_max = 1.3;

  auto members() const { return std::tie(axis_min, axis_max, exponent_min, exponent_max); }
};

/// One of this size, m, turned at random; its `area` is its volume, m3.
ShapedGrain draw_superellipsoid(const SuperellipsoidFamily& family, double size, Random& random);

/// Expected volume of one of this size, m3.
double mean_volume(const SuperellipsoidFamily& family, double size);

/// Radii of this size, m: the least extent that can be drawn, the radius of the sphere of mean
/// volume, and the farthest point that can be drawn.
struct FamilyRadii {
  double least = 0, mean = 0, most = 0;
};
FamilyRadii radii_of(const SuperellipsoidFamily& family, double size);

/// Volume of the bodies over that of the balls about them, in all, about.
double share_of_balls(const SuperellipsoidFamily& family);

/// What bounds the time step: the one that a push moves most easily.
GrainExtremes extremes_of_superellipsoids(const std::vector<ShapedGrain>& grains, double density);

}  // namespace grainfield::dem
