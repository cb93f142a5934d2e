#include "dem/grains/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/grains/layer_3d.h"
#include "dem/grains/placed.h"
#include "dem/shapes/pair_memory.h"
#include "dem/shared/refuse.h"

namespace grainfield::dem {
namespace {

// Spacing of a lattice along a row and from row to row, in diameters.
double along_row(const PackingSetup& p) {
  return p.kind == "triangular" ? 1.0 : std::sqrt(3.0) * p.spacing;
}
double row_to_row(const PackingSetup& p) {
  const double half = 0.5 * along_row(p);
  return std::sqrt(1 - half * half);
}

// Circumscribed and inscribed radius of irregular pentagons (grain_family.h) over their mean side,
// bounds: the regular one has 0.851 and 0.688.
constexpr double kPentagonCircumradius = 1.25, kPentagonInradius = 0.4;
// Their mean area over side^2 is 1.6, less is taken.
constexpr double kPentagonArea = 1.4;

}  // namespace

bool draws_pentagons(const PackingSetup& p) {
  return p.kind == "layered" && p.shape == "irregular";
}

double pentagons_drawn(const PackingSetup& p) {
  // A layer's worth at a volume fraction of 1, and three rows more: what lies above the depth at
  // the end, and a rough floor.
  const double area = p.width * (p.depth + 6 * largest_radius(p));
  return area / (kPentagonArea * p.side * p.side);
}

ShapeSetup pentagon(const PackingSetup& p) {
  ShapeSetup s;
  s.kind = "irregular";
  s.polydispersity = 0;
  s.side = p.side;
  return s;
}

void check_packing(const PackingSetup& p) {
  if (p.dim == 3) return check_layer_3d(p);
  if (p.shape == "regular") {
    require(p.corners >= 3 && p.corners <= kMostCorners, "packing.corners", p.corners,
            fmt::format("3 to {}", kMostCorners));
  }
  if (p.kind == "layered") {
    require(p.width >= 4 * largest_radius(p), "packing.width", p.width,
            "at least two grain diameters");
    require(p.depth >= 2 * largest_radius(p), "packing.depth", p.depth,
            "at least one grain diameter");
    require(p.drop_height >= 0, "packing.drop_height", p.drop_height, "0 or more");
    if (p.shape == "irregular") require(p.side > 0, "packing.side", p.side, "above 0");
  } else {
    if (p.shape != "disk" && p.shape != "regular") {
      throw std::invalid_argument(fmt::format(
          "packing.shape: found {}, allowed: disk, regular, because packing.kind = {} is a lattice",
          p.shape, p.kind));
    }
    require(p.columns >= 2, "packing.columns", p.columns, "2 or more");
    require(p.rows >= 1, "packing.rows", p.rows, "1 or more");
    if (p.sizes != "mono") {
      throw std::invalid_argument(fmt::format(
          "packing.sizes: found {}, allowed: mono, because packing.kind = {} is a lattice", p.sizes,
          p.kind));
    }
    require(p.spacing > 0.7 && p.spacing <= 1, "packing.spacing", p.spacing,
            "above 0.7, at most 1");
    require(p.jitter >= 0 && p.jitter < 0.5, "packing.jitter", p.jitter, "0 to below 0.5");
  }
  require(smallest_radius(p) > 0, "packing.radius", smallest_radius(p), "above 0");
  if (p.sizes == "uniform") {
    require(p.radius_max >= p.radius_min, "packing.radius_max", p.radius_max,
            "at least packing.radius_min");
  }
}

double draw_radius(const PackingSetup& p, Random& random) {
  if (p.sizes == "bidisperse") {
    return random.uniform() < p.fraction_small ? p.radius_small : p.radius;
  }
  if (p.sizes == "uniform") return random.uniform(p.radius_min, p.radius_max);
  return p.jitter > 0 ? p.radius * (1 - 2 * p.jitter * random.uniform()) : p.radius;
}

double largest_radius(const PackingSetup& p) {
  if (draws_pentagons(p)) return kPentagonCircumradius * p.side;
  if (p.sizes == "bidisperse") return std::max(p.radius, p.radius_small);
  return p.sizes == "uniform" ? p.radius_max : p.radius;
}

double mean_radius(const PackingSetup& p) {
  if (draws_pentagons(p)) return 0.85 * p.side;
  if (p.sizes == "bidisperse") {
    return p.fraction_small * p.radius_small + (1 - p.fraction_small) * p.radius;
  }
  return p.sizes == "uniform" ? 0.5 * (p.radius_min + p.radius_max) : p.radius;
}

double smallest_radius(const PackingSetup& p) {
  if (draws_pentagons(p)) return kPentagonInradius * p.side;
  if (p.sizes == "bidisperse") return std::min(p.radius, p.radius_small);
  return p.sizes == "uniform" ? p.radius_min : p.radius * (1 - 2 * p.jitter);
}

double layer_width(const PackingSetup& p) {
  const double d = 2 * p.radius;
  if (p.kind == "triangular") return p.columns * d;
  if (p.kind == "sqrt3") return ((p.columns - 1) * along_row(p) + 1) * d;
  return p.width;
}

std::vector<Wall> layer_walls(const PackingSetup& p, const MaterialSetup& material) {
  const double half = 0.5 * layer_width(p);
  const bool rough = p.floor == "rough";
  std::vector<Wall> walls(3);
  // Below a rough floor's grains the plane is out of reach.
  walls[0] = {"floor", Vec3(0, rough ? -2 * largest_radius(p) : 0.0, 0), Vec3(0, 1, 0),
              material.floor_friction};
  walls[1] = {"left", Vec3(-half, 0, 0), Vec3(1, 0, 0), material.wall_friction};
  walls[2] = {"right", Vec3(half, 0, 0), Vec3(-1, 0, 0), material.wall_friction};
  return walls;
}

namespace {

void add_row(const PackingSetup& p, bool shifted, double y, double density, bool fixed,
             Random& random, std::vector<NewGrain>& grains) {
  const double along = along_row(p) * 2 * p.radius;
  const int count = shifted ? p.columns - 1 : p.columns;
  for (int k = 0; k < count; ++k) {
    const double radius = fixed ? p.radius : draw_radius(p, random);
    NewGrain g = round_grain(p, radius, random).at((k - 0.5 * (count - 1)) * along, y, density);
    g.fixed = fixed;
    grains.push_back(g);
  }
}

}  // namespace

ShapedGrain round_grain(const PackingSetup& p, double radius, Random& random) {
  if (p.shape != "regular") return disk_grain(radius);
  ShapeSetup s;
  s.kind = "regular";
  s.radius = radius;
  s.polydispersity = 0;
  s.corners_min = s.corners_max = p.corners;
  return draw_grain(s, random);
}

GrainSupply::GrainSupply(const PackingSetup& packing, Random& random, double most)
    : packing_(packing) {
  if (!draws_pentagons(packing)) return;
  const ShapeSetup shape = pentagon(packing);
  const auto count = static_cast<std::size_t>(std::min(pentagons_drawn(packing), most));
  while (drawn_.size() < count) drawn_.push_back(draw_grain(shape, random));
}

std::vector<ShapedGrain> GrainSupply::fill(double width, Random& random) {
  std::vector<ShapedGrain> out;
  double slack = width;
  while (true) {
    if (draws_pentagons(packing_) && taken_ == static_cast<long>(drawn_.size())) {
      throw ComputationFailed(fmt::format(
          "the layer does not reach packing.depth = {:g} m with {} grains; lower packing.depth",
          packing_.depth, taken_));
    }
    const ShapedGrain next = draws_pentagons(packing_)
                                 ? drawn_[taken_]
                                 : round_grain(packing_, draw_radius(packing_, random), random);
    // Rounding must not cost a row its last grain.
    if (2 * next.radius > slack * (1 + 1e-9)) return out;
    ++taken_;
    slack -= 2 * next.radius;
    out.push_back(next);
  }
}

GrainExtremes GrainSupply::extremes(double density) const {
  if (!drawn_.empty()) return extremes_of(drawn_, density);
  if (packing_.shape == "regular") {
    // All are alike but for their size.
    Random any(0);
    return extremes_of({round_grain(packing_, smallest_radius(packing_), any)}, density);
  }
  GrainExtremes e;
  e.least_mass = density * disk_grain(smallest_radius(packing_)).area;
  return e;
}

std::vector<NewGrain> floor_grains(const PackingSetup& p, GrainSupply& supply, double density,
                                   Random& random) {
  std::vector<NewGrain> grains;
  if (p.floor != "rough") return grains;
  if (p.kind != "layered") {
    add_row(p, false, -p.radius, density, true, random, grains);
    return grains;
  }
  const double width = layer_width(p);
  const std::vector<ShapedGrain> row = supply.fill(width, random);
  double slack = width;
  for (const ShapedGrain& g : row) slack -= 2 * g.radius;
  const double gap = row.empty() ? 0 : slack / static_cast<double>(row.size());
  double x = -0.5 * width;
  for (const ShapedGrain& shaped : row) {
    NewGrain g = shaped.at(x + 0.5 * gap + shaped.radius, -shaped.radius, density);
    g.fixed = true;
    grains.push_back(g);
    x += 2 * shaped.radius + gap;
  }
  return grains;
}

std::vector<NewGrain> lattice_grains(const PackingSetup& p, double density, Random& random) {
  std::vector<NewGrain> grains;
  const double up = row_to_row(p) * 2 * p.radius;
  // On a rough floor the lattice goes on from the fixed row, whose centres are at y = -r.
  const bool rough = p.floor == "rough";
  const double base = rough ? up - p.radius : p.radius;
  for (int row = 0; row < p.rows; ++row) {
    add_row(p, (row % 2 == 1) != rough, base + row * up, density, false, random, grains);
  }
  return grains;
}

std::vector<NewGrain> row_of_grains(const PackingSetup& p, GrainSupply& supply, double density,
                                    double y, Random& random) {
  const double half = 0.5 * layer_width(p);
  return side_by_side(supply.fill(2 * half, random), -half, half, y, density, random);
}

double surface_height(const Snapshot& snapshot, double width) {
  double radius_sum = 0;
  int count = 0;
  for (const Grain& g : snapshot.grains) {
    if (g.fixed) continue;
    radius_sum += g.radius;
    ++count;
  }
  if (count == 0) return 0;
  const int strips = std::max(1, static_cast<int>(width / (4 * radius_sum / count)));
  std::vector<double> top(strips, 0.0);
  for (const Grain& g : snapshot.grains) {
    if (g.fixed) continue;
    const int k =
        std::clamp(static_cast<int>((g.position.x() / width + 0.5) * strips), 0, strips - 1);
    top[k] = std::max(top[k], top_of(g));
  }
  double sum = 0;
  for (const double t : top) sum += t;
  return sum / strips;
}

}  // namespace grainfield::dem
