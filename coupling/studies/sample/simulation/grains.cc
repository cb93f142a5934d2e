#include "coupling/studies/sample/simulation/grains.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coupling/studies/sample/simulation/drop.h"
#include "dem/grains/loose.h"
#include "dem/grains/superellipsoid_family.h"
#include "dem/space/elementary.h"

namespace grainfield::dem {
namespace {

bool is_round(const SamplePlan& plan) { return plan.shape == "disk" || plan.shape == "sphere"; }

bool is_superellipsoid(const SamplePlan& plan) { return plan.shape == "superellipsoid"; }

double volume_of(double radius, int dim) {
  return dim == 2 ? std::numbers::pi * radius * radius
                  : 4.0 / 3 * std::numbers::pi * radius * radius * radius;
}

bool scales_axes(const SamplePlan& plan) { return plan.axes_times == "sizes"; }

SuperellipsoidFamily family_of(const SamplePlan& p) {
  return {p.axis_min, p.axis_max, p.exponent_min, p.exponent_max};
}

ShapedGrain draw(const SamplePlan& plan, double radius, Random& random) {
  if (is_superellipsoid(plan)) {
    return draw_superellipsoid(family_of(plan), scales_axes(plan) ? radius : plan.radius, random);
  }
  if (is_round(plan)) {
    ShapedGrain grain;
    grain.radius = radius;
    grain.area = volume_of(radius, plan.dim);
    return grain;
  }
  ShapeSetup shape;
  shape.kind = plan.shape;
  shape.radius = radius;
  shape.polydispersity = 0;
  shape.corners_min = plan.corners_min;
  shape.corners_max = plan.corners_max;
  return draw_grain(shape, random);
}

// The number of `grains` bidisperse ones that are small.
int small_ones(const SamplePlan& plan) {
  return static_cast<int>(std::lround(plan.fraction_small * plan.grains));
}

// Sizes over the radius: smallest and largest, and the mean of the cube.
struct SizeRange {
  double least = 1, most = 1, cube = 1;
};
SizeRange size_range(const SamplePlan& p) {
  const double d = p.polydispersity;
  if (p.sizes == "uniform") return {1 - d, 1 + d, 1 + d * d};
  if (p.sizes == "mono") return {};
  const int few = small_ones(p);
  const double small = 1 / p.size_ratio, share = 1.0 * few / p.grains;
  return {few > 0 ? small : 1, few < p.grains ? 1 : small,
          share * small * small * small + (1 - share)};
}

// One of those sizes, over the radius.
double draw_size(const SamplePlan& p, Random& random) {
  if (p.sizes == "uniform") return 1 + p.polydispersity * random.uniform(-1, 1);
  if (p.sizes == "mono") return 1;
  return random.uniform() * p.grains < small_ones(p) ? 1 / p.size_ratio : 1;
}

}  // namespace

const std::vector<std::string>& sample_shapes(int dim) {
  static const std::vector<std::string> plane{"disk", "rand1", "regular"},
      space{"sphere", "superellipsoid"};
  return dim == 2 ? plane : space;
}

SampleRadii sample_radii(const SamplePlan& p) {
  const double r = p.radius;
  if (is_superellipsoid(p)) {
    const FamilyRadii of_one = radii_of(family_of(p), r);
    const SampleRadii one{of_one.least, of_one.mean, of_one.most};
    if (!scales_axes(p)) return one;
    const SizeRange sizes = size_range(p);
    return {one.least * sizes.least, one.mean * cube_root(sizes.cube), one.most * sizes.most};
  }
  if (p.sizes == "uniform") return {r * (1 - p.polydispersity), r, r * (1 + p.polydispersity)};
  if (p.sizes == "mono") return {r, r, r};
  const int few = small_ones(p);
  const double small = r / p.size_ratio, share = 1.0 * few / p.grains;
  return {few > 0 ? small : r, share * small + (1 - share) * r, few < p.grains ? r : small};
}

SampleRadii gap_radii(const SamplePlan& p) {
  if (!is_superellipsoid(p)) return sample_radii(p);
  const SizeRange sizes = scales_axes(p) ? size_range(p) : SizeRange{};
  const double least = p.axis_min * p.radius * sizes.least,
               most = p.axis_max * p.radius * sizes.most;
  return {least, 0.5 * (least + most), most};
}

double draw_gap_radius(const SamplePlan& p, Random& random) {
  const auto axis = [&] { return random.uniform(p.axis_min * p.radius, p.axis_max * p.radius); };
  if (!is_superellipsoid(p)) return p.radius * draw_size(p, random);
  if (!scales_axes(p)) return axis();
  const double size = draw_size(p, random);
  return size * axis();
}

double mean_volume(const SamplePlan& p) {
  const double one = volume_of(p.radius, p.dim), n = p.grains;
  if (is_superellipsoid(p)) {
    return n * mean_volume(family_of(p), p.radius) * (scales_axes(p) ? size_range(p).cube : 1);
  }
  if (p.sizes == "uniform") {
    // Second and third moments of a size uniform in 1 -+ d: 1 + d^2/3 and 1 + d^2.
    const double d2 = p.polydispersity * p.polydispersity;
    return n * one * (1 + (p.dim == 2 ? d2 / 3 : d2));
  }
  if (p.sizes == "mono") return n * one;
  const double few = small_ones(p);
  return few * volume_of(p.radius / p.size_ratio, p.dim) + (n - few) * one;
}

std::vector<ShapedGrain> draw_sample(const SamplePlan& plan, Random& random, Allowance& allowance) {
  SamplePlan p = plan;
  p.grains = is_round(p) ? allowance.at_most(p.grains) : allowance.grant(p.grains);
  std::vector<ShapedGrain> grains;
  grains.reserve(static_cast<std::size_t>(p.grains));
  const int small = p.sizes == "bidisperse" ? small_ones(p) : 0;
  for (int k = 0; k < p.grains; ++k) {
    double radius = k < small ? p.radius / p.size_ratio : p.radius;
    if (p.sizes == "uniform") radius *= 1 + p.polydispersity * random.uniform(-1, 1);
    grains.push_back(draw(p, radius, random));
  }
  return grains;
}

std::vector<ShapedGrain> draw_sample(const SamplePlan& plan, Random& random) {
  Allowance all;
  return draw_sample(plan, random, all);
}

double most_start_fraction(const SamplePlan& p) {
  if (!is_superellipsoid(p)) return p.dim == 2 ? kMostLoose2 : kMostLoose3;
  return kMostLoose3 * share_of_balls(family_of(p));
}

GrainExtremes sample_extremes(const SamplePlan& p, double density,
                              const std::vector<ShapedGrain>& grains) {
  if (is_superellipsoid(p)) {
    std::vector<ShapedGrain> all = grains;
    if (is_dropped(p)) {  // the least sphere that may fill its gap
      all.emplace_back().axes.fill(gap_radii(p).least);
    }
    return extremes_of_superellipsoids(all, density);
  }
  if (!is_round(p)) return extremes_of(grains, density);
  const double least = sample_radii(p).least;
  GrainExtremes extremes;
  extremes.least_mass = density * volume_of(least, p.dim);
  extremes.least_radius = least;
  return extremes;
}

std::array<double, 3> sample_box(const SamplePlan& p, double volume) {
  if (is_dropped(p)) {
    // The base is that of a box filled by grains of mean volume, the same for all seeds; so high
    // that the loose grains have their places.
    std::array<double, 3> box = sample_box(as_filled(p), mean_volume(p));
    box[2] = volume / p.start_fraction / (box[0] * box[1]);
    return box;
  }
  const double level = volume / p.start_fraction / p.height_ratio;
  const double edge = p.dim == 2 ? std::sqrt(level) : cube_root(level);
  std::array<double, 3> box{edge, edge, edge};
  box[p.dim - 1] *= p.height_ratio;
  return box;
}

std::vector<NewGrain> place_sample(const SamplePlan& p, const std::vector<ShapedGrain>& grains,
                                   const std::array<double, 3>& box, double density,
                                   Random& random) {
  std::vector<double> radii;
  for (const ShapedGrain& grain : grains) radii.push_back(grain.radius);
  const auto places = place_loosely(radii, box, p.dim, p.boundary == "periodic", random);
  std::vector<NewGrain> out;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    out.push_back(grains[k].at(places[k][0], places[k][1], density));
    if (p.dim == 3) out.back().z = places[k][2];
  }
  return out;
}

}  // namespace grainfield::dem
