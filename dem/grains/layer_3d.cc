#include "dem/grains/layer_3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dem/grains/loose.h"
#include "dem/grains/reach.h"
#include "dem/grains/superellipsoid_family.h"
#include "dem/shared/refuse.h"

namespace grainfield::dem {
namespace {

// Share of the box that spheres fill before they settle: far below where places become rare, also
// between walls, which keep centres a radius away.
constexpr double kLooseFraction = 0.25;
// A cell must be wide enough that a sphere does not touch another and its image.
constexpr double kLeastDiameters = 4;
// Distance of neighbours in a close packed layer over their diameter: closer ones overlap too much.
constexpr double kLeastSpacing = 0.9;

double volume_of(double radius) { return 4.0 / 3 * std::numbers::pi * radius * radius * radius; }

bool is_lattice(const PackingSetup& p) { return p.kind == "close_packed"; }

void check_lattice(const PackingSetup& p) {
  if (p.sizes != "mono")
    refuse("packing.sizes", p.sizes, "mono, because packing.kind = close_packed is a lattice");
  if (p.columns < kLeastDiameters) {
    refuse("packing.columns", fmt::format("{}", p.columns),
           fmt::format("{:g} or more", kLeastDiameters));
  }
  if (p.rows < 1) refuse("packing.rows", fmt::format("{}", p.rows), "1 or more");
  if (!(p.jitter >= 0 && p.jitter < 0.5)) {
    refuse("packing.jitter", fmt::format("{:g}", p.jitter), "0 to below 0.5");
  }
  if (!(p.spacing >= kLeastSpacing && p.spacing <= 1)) {
    refuse("packing.spacing", fmt::format("{:g}", p.spacing),
           fmt::format("{:g} to 1 with packing.kind = close_packed", kLeastSpacing));
  }
  if (p.spacing < 1 && p.sides != "periodic") {
    refuse("packing.spacing", fmt::format("{:g}", p.spacing),
           "1 between walls, which would be overlapped");
  }
}

SuperellipsoidFamily family_of(const PackingSetup& p) {
  return {p.axis_min, p.axis_max, p.exponent_min, p.exponent_max};
}

void check_family(const PackingSetup& p) {
  if (p.axis_min > p.axis_max) {
    refuse("packing.axis_min", fmt::format("{:g}", p.axis_min),
           fmt::format("up to packing.axis_max = {:g}", p.axis_max));
  }
  if (p.exponent_min > p.exponent_max) {
    refuse("packing.exponent_min", fmt::format("{:g}", p.exponent_min),
           fmt::format("up to packing.exponent_max = {:g}", p.exponent_max));
  }
}

// Least extent of a grain from its centre, m.
double least_reach(const PackingSetup& p) {
  const double least = smallest_radius(p);
  return is_angular(p) ? radii_of(family_of(p), least).least : least;
}

double floor_gap(const PackingSetup& p);

void check_random(const PackingSetup& p) {
  const double most = farthest_reach(p);
  if (!(p.width >= 2 * kLeastDiameters * most)) {
    refuse("packing.width", fmt::format("{:g}", p.width),
           fmt::format("at least {:g} of the largest diameters", kLeastDiameters));
  }
  if (!(p.depth >= 2 * most)) {
    refuse("packing.depth", fmt::format("{:g}", p.depth), "at least one grain diameter");
  }
  if (p.floor == "rough" && least_reach(p) + largest_radius(p) <= floor_gap(p)) {
    refuse("packing.floor", "rough",
           fmt::format("smooth with grains down to {:.3g} m, which fall between floor spheres of "
                       "{:.3g} m",
                       least_reach(p), largest_radius(p)));
  }
  if (p.sizes == "uniform" && p.radius_max < p.radius_min) {
    refuse("packing.radius_max", fmt::format("{:g}", p.radius_max), "at least packing.radius_min");
  }
}

NewGrain sphere_at(double x, double y, double z, double radius, double density) {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.z = z;
  g.radius = radius;
  g.density = density;
  return g;
}

// Rows of spheres along y of the densest horizontal layer on these sides, and spheres in a row,
// `apart` being the least distance of centres. With periodic sides the rows are even in number.
struct Rows {
  int along = 0, count = 0;
};
Rows densest(const std::array<double, 2>& sides, double apart) {
  Rows out;
  out.along = std::max(1, static_cast<int>(std::floor(sides[0] / apart * (1 + 1e-9))));
  const double rows = sides[1] / (apart * std::sqrt(3.0) / 2);
  out.count = std::max(2, 2 * static_cast<int>(std::floor(rows / 2 * (1 + 1e-9))));
  return out;
}

// From the middle of three spheres of a rough floor to their centres. A grain passes between them
// where its radius and theirs are less together.
double floor_gap(const PackingSetup& p) {
  const std::array<double, 2> sides{p.width, p.width};
  const Rows rows = densest(sides, 2 * largest_radius(p));
  const double spacing =
      std::max(sides[0] / rows.along, sides[1] / rows.count * 2 / std::sqrt(3.0));
  return spacing / std::sqrt(3.0);
}

int rows_of(const PackingSetup& p) {
  return std::max(4, 2 * static_cast<int>(std::lround(p.columns / std::sqrt(3.0))));
}

// Between walls every centre keeps a radius from them: what is shifted over the end is left out.
bool fits(const PackingSetup& p, const std::array<double, 2>& sides, double x, double y) {
  if (p.sides == "periodic") return true;
  const double reach = 1 - 1e-9;
  return std::fabs(x) <= 0.5 * sides[0] - reach * p.radius &&
         std::fabs(y) <= 0.5 * sides[1] - reach * p.radius;
}

// A horizontal layer of a close packing: `shift` 0, 1 or 2 is A, B or C.
void add_layer(const PackingSetup& p, int shift, double z, double density, bool fixed,
               Random& random, std::vector<NewGrain>& grains) {
  const double d = 2 * p.radius * p.spacing, step = d * std::sqrt(3.0) / 2;
  const auto sides = layer_sides(p);
  const int rows = rows_of(p);
  const double x0 = 0.5 * (d - sides[0]), y0 = 0.5 * (d - sides[1]);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < p.columns; ++i) {
      double x = x0 + d * (i + 0.5 * (j % 2)) + 0.5 * d * shift;
      double y = y0 + step * (j + shift / 3.0);
      // What a shifted layer has beyond the far side is what it lacks on the near one.
      if (p.sides == "periodic") {
        x -= sides[0] * std::floor((x + 0.5 * sides[0]) / sides[0]);
        y -= sides[1] * std::floor((y + 0.5 * sides[1]) / sides[1]);
      }
      if (!fits(p, sides, x, y)) continue;
      const double radius = fixed ? p.radius : draw_radius(p, random);
      grains.push_back(sphere_at(x, y, z, radius, density));
      grains.back().fixed = fixed;
    }
  }
}

// 0, 1, 2 of the layer with this number, from 0; -1 is the floor's.
int stacked(const PackingSetup& p, int number) {
  return p.stacking == "hcp" ? (number + 2) % 2 : (number + 3) % 3;
}

std::vector<NewGrain> lattice(const PackingSetup& p, double density, Random& random) {
  std::vector<NewGrain> grains;
  const double up = 2 * p.radius * std::sqrt(1 - p.spacing * p.spacing / 3);
  const bool rough = p.floor == "rough";
  for (int k = 0; k < p.rows; ++k) {
    const double z = rough ? up * (k + 1) - p.radius : up * k + p.radius;
    add_layer(p, stacked(p, k), z, density, false, random, grains);
  }
  return grains;
}

}  // namespace

void check_layer_3d(const PackingSetup& p) {
  if (p.kind != "close_packed" && p.kind != "random") {
    refuse("packing.kind", p.kind, "close_packed, random with packing.dim = 3");
  }
  if (!(smallest_radius(p) > 0)) {
    refuse("packing.radius", fmt::format("{:g}", smallest_radius(p)), "above 0");
  }
  if (p.shape == "irregular" || p.shape == "regular")
    refuse("packing.shape", p.shape, "disk | superellipsoid with packing.dim = 3");
  if (p.shape == "superellipsoid") {
    if (is_lattice(p))
      refuse("packing.shape", p.shape, "disk, because packing.kind = close_packed is a lattice");
    check_family(p);
  }
  is_lattice(p) ? check_lattice(p) : check_random(p);
}

bool is_angular(const PackingSetup& p) {
  return p.dim == 3 && p.kind == "random" && p.shape == "superellipsoid";
}

double farthest_reach(const PackingSetup& p) {
  return is_angular(p) ? radii_of(family_of(p), largest_radius(p)).most : largest_radius(p);
}

std::vector<ShapedGrain> draw_layer(const PackingSetup& p, Random& random,
                                    const std::function<bool()>& may_follow) {
  const auto sides = layer_sides(p);
  const double goal = kSettledFraction * sides[0] * sides[1] * p.depth;
  std::vector<ShapedGrain> out;
  for (double filled = 0; filled < goal && may_follow();) {
    const double radius = draw_radius(p, random);
    if (is_angular(p)) {
      out.push_back(draw_superellipsoid(family_of(p), radius, random));
    } else {
      out.emplace_back();
      out.back().radius = radius;
      out.back().area = volume_of(radius);
    }
    filled += out.back().area;
  }
  return out;
}

double mean_sphere_radius(const PackingSetup& p) {
  if (p.sizes == "uniform") return 0.5 * (p.radius_min + p.radius_max);
  if (p.sizes == "bidisperse") {
    return p.fraction_small * p.radius_small + (1 - p.fraction_small) * p.radius;
  }
  return p.radius * (1 - p.jitter);
}

double mean_sphere_volume(const PackingSetup& p) {
  // What spheres of the same sizes have, times this, is that of superellipsoids.
  const double shape = is_angular(p) ? mean_volume(family_of(p), 1) / volume_of(1) : 1;
  if (p.sizes == "bidisperse") {
    return shape * (p.fraction_small * volume_of(p.radius_small) +
                    (1 - p.fraction_small) * volume_of(p.radius));
  }
  // The mean cube of a radius uniform in [a, b] is (a + b)(a^2 + b^2)/4.
  const double a = smallest_radius(p), b = largest_radius(p);
  return shape * (std::numbers::pi / 3 * (a + b) * (a * a + b * b));
}

std::array<double, 2> layer_sides(const PackingSetup& p) {
  if (!is_lattice(p)) return {p.width, p.width};
  const double d = 2 * p.radius * p.spacing;
  if (p.sides == "periodic") return {p.columns * d, rows_of(p) * d * std::sqrt(3.0) / 2};
  // Between walls the rows end with whole spheres.
  return {(p.columns + 0.5) * d, (1 + (rows_of(p) - 1) * std::sqrt(3.0) / 2) * d};
}

double layer_spheres(const PackingSetup& p) {
  if (is_lattice(p)) return static_cast<double>(p.columns) * rows_of(p) * p.rows;
  return kSettledFraction * p.width * p.width * p.depth / mean_sphere_volume(p);
}

double floor_spheres(const PackingSetup& p) {
  if (p.floor != "rough") return 0;
  if (is_lattice(p)) return static_cast<double>(p.columns) * rows_of(p);
  const Rows rows = densest(layer_sides(p), 2 * largest_radius(p));
  return static_cast<double>(rows.along) * rows.count;
}

double loose_height(const PackingSetup& p) {
  const auto sides = layer_sides(p);
  const double fraction = kLooseFraction * (is_angular(p) ? share_of_balls(family_of(p)) : 1);
  return layer_spheres(p) * mean_sphere_volume(p) / (fraction * sides[0] * sides[1]) +
         4 * farthest_reach(p);
}

Cell<3> layer_cell(const PackingSetup& p) {
  Cell<3> cell;
  if (p.sides != "periodic") return cell;
  const auto sides = layer_sides(p);
  for (int a = 0; a < 2; ++a) {
    cell.periodic[a] = true;
    cell.edges(a, a) = sides[a];
    cell.low[a] = -0.5 * sides[a];
  }
  return cell;
}

std::vector<Wall> walls_3d(const PackingSetup& p, const MaterialSetup& material) {
  const double below = p.floor == "rough" ? -2 * largest_radius(p) : 0;
  std::vector<Wall> walls{{"floor", Vec3(0, 0, below), Vec3(0, 0, 1), material.floor_friction}};
  if (p.sides == "periodic") return walls;
  const auto sides = layer_sides(p);
  const auto add = [&](const char* name, int axis, double sign) {
    walls.push_back({name, -0.5 * sign * sides[axis] * Vec3::Unit(axis), sign * Vec3::Unit(axis),
                     material.wall_friction});
  };
  add("left", 0, 1);
  add("right", 0, -1);
  add("front", 1, 1);
  add("back", 1, -1);
  return walls;
}

std::vector<NewGrain> floor_3d(const PackingSetup& p, double density, Random& random) {
  std::vector<NewGrain> grains;
  if (p.floor != "rough") return grains;
  if (is_lattice(p)) {
    add_layer(p, stacked(p, -1), -p.radius, density, true, random, grains);
    return grains;
  }
  const auto sides = layer_sides(p);
  const Rows rows = densest(sides, 2 * largest_radius(p));
  const double along = sides[0] / rows.along, across = sides[1] / rows.count;
  const bool would_pass = least_reach(p) + smallest_radius(p) <= floor_gap(p);
  for (int j = 0; j < rows.count; ++j) {
    for (int i = 0; i < rows.along; ++i) {
      const double drawn = draw_radius(p, random);
      const double radius = would_pass ? largest_radius(p) : drawn;
      const double x = -0.5 * sides[0] + along * (i + 0.25 + 0.5 * (j % 2));
      const double y = -0.5 * sides[1] + across * (j + 0.5);
      grains.push_back(sphere_at(x, y, -radius, radius, density));
      grains.back().fixed = true;
      if (is_angular(p)) grains.back().axes.fill(radius);
    }
  }
  return grains;
}

std::vector<NewGrain> grains_3d(const PackingSetup& p, double density, Random& random) {
  return is_lattice(p) ? lattice(p, density, random)
                       : place_layer(p, draw_layer(p, random), density, random);
}

std::vector<NewGrain> place_layer(const PackingSetup& p, const std::vector<ShapedGrain>& drawn,
                                  double density, Random& random) {
  std::vector<double> radii;
  for (const ShapedGrain& g : drawn) radii.push_back(g.radius);
  const auto sides = layer_sides(p);
  const double margin = farthest_reach(p);
  const std::array<double, 3> box{sides[0], sides[1], loose_height(p)};
  const bool periodic = p.sides == "periodic";
  const auto places = place_loosely(radii, box, 3, periodic, random);
  std::vector<NewGrain> grains;
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const auto& at = places[k];
    grains.push_back(drawn[k].at(at[0] - 0.5 * sides[0], at[1] - 0.5 * sides[1], density));
    grains.back().z = at[2] + margin;
  }
  return grains;
}

double surface_3d(const Snapshot& snapshot, const PackingSetup& p) {
  double diameters = 0;
  int count = 0;
  for (const Grain& g : snapshot.grains) {
    if (g.fixed) continue;
    diameters += 2 * g.radius;
    ++count;
  }
  if (count == 0) return 0;
  const auto sides = layer_sides(p);
  std::array<int, 2> columns{};
  for (int a = 0; a < 2; ++a) {
    columns[a] = std::max(1, static_cast<int>(sides[a] / (2 * diameters / count)));
  }
  std::vector<double> top(static_cast<std::size_t>(columns[0]) * columns[1], 0.0);
  for (const Grain& g : snapshot.grains) {
    if (g.fixed) continue;
    std::array<int, 2> at{};
    for (int a = 0; a < 2; ++a) {
      const double share = g.position[a] / sides[a] + 0.5;
      at[a] = std::clamp(static_cast<int>(share * columns[a]), 0, columns[a] - 1);
    }
    double& here = top[static_cast<std::size_t>(at[1]) * columns[0] + at[0]];
    here = std::max(here, top_3d(g));
  }
  double sum = 0;
  for (const double t : top) sum += t;
  return sum / static_cast<double>(top.size());
}

}  // namespace grainfield::dem
