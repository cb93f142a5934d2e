// The grains of a sample and the box that holds them, drawn from a seed.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "coupling/studies/sample/simulation/setup.h"
#include "dem/engine/engine.h"
#include "dem/grains/grain_family.h"
#include "dem/run/groundwork.h"

namespace grainfield::dem {

/// Words of the shapes of two or three dimensions that samples are made of.
const std::vector<std::string>& sample_shapes(int dim);

/// Radii of the circles (spheres) that carry the grains, m: smallest, mean and largest that can be
/// drawn. A polygon's own circle, about its centroid, may be a little larger. Of superellipsoids:
/// the least extent, the radius of the sphere of mean volume, and the farthest point.
struct SampleRadii {
  double least = 0, mean = 0, most = 0;
};
SampleRadii sample_radii(const SamplePlan& plan);
/// Expected volume of all grains, m3 (m2): of the circles (spheres) that carry them; of
/// superellipsoids of themselves.
double mean_volume(const SamplePlan& plan);

/// Radii of the spheres that fill the gap below a dropped sample's lid, m: those of the grains, of
/// superellipsoids their semi-axes.
SampleRadii gap_radii(const SamplePlan& plan);
/// One of them.
double draw_gap_radius(const SamplePlan& plan, Random& random);

/// In the order of their ids; of spheres `area` is the volume, m3.
std::vector<ShapedGrain> draw_sample(const SamplePlan& plan, Random& random, Allowance& allowance);
std::vector<ShapedGrain> draw_sample(const SamplePlan& plan, Random& random);  ///< all of them

/// Solid fraction that grains placed at random without overlap may have at most, about: of
/// superellipsoids that of the spheres about them.
double most_start_fraction(const SamplePlan& plan);

/// What bounds the time step. Round grains: of the smallest that can be drawn; others: of these.
/// Extremes of the grains; of superellipsoids the one that a push moves most easily.
GrainExtremes sample_extremes(const SamplePlan& plan, double density,
                              const std::vector<ShapedGrain>& grains);

/// Edges of the box, m, that grains of this volume (area) fill to plan.start_fraction.
std::array<double, 3> sample_box(const SamplePlan& plan, double volume);

/// The grains at rest at random places of the box. Throws ComputationFailed when there is no room.
std::vector<NewGrain> place_sample(const SamplePlan& plan, const std::vector<ShapedGrain>& grains,
                                   const std::array<double, 3>& box, double density,
                                   Random& random);

}  // namespace grainfield::dem
