// Where grains and walls of a layer start: lattices, and rows to be dropped one after the other.
// The floor's surface is y = 0; the layer spans x in [-width/2, width/2] between side walls.
#pragma once
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/grains/grain_family.h"
#include "dem/laws/material_setup.h"
#include "dem/random/random.h"

namespace grainfield::dem {

struct PackingSetup {
  int dim = 2;                     ///< 2: disks and pentagons; 3: spheres (layer_3d.h)
  std::string kind = "layered";    ///< triangular | sqrt3 | layered; 3D: close_packed | random
  std::string sizes = "uniform";   ///< mono | bidisperse | uniform
  double radius = 0.0045;          ///< m; mono, and the larger of bidisperse
  double radius_small = 0.0035;    ///< m; the smaller of bidisperse
  double fraction_small = 0.5;     ///< share by number of the smaller grains
  double radius_min = 0.0036;      ///< m; uniform
  double radius_max = 0.0054;      ///< m; uniform
  int columns = 64;                ///< lattices: grains in a row
  int rows = 16;                   ///< lattices: rows; 3D: horizontal layers
  double spacing = 1;              ///< sqrt3: spacing in a row / (sqrt(3) d), up to 1; below 1 rows
                                   ///< two apart do not touch, and a grain has four contacts;
                                   ///< close_packed: of neighbours in a layer over d, 0.9 to 1
  double width = 0.6;              ///< m; layered, random
  double depth = 0.15;             ///< m; layered: rows are dropped until this height is reached;
                                   ///< random: grains are counted out for it
  double drop_height = 0.008;      ///< m above the surface from which a row is dropped
  std::string floor = "smooth";    ///< smooth (flat wall with friction) | rough (fixed grains)
  double jitter = 0;               ///< lattices: relative spread of radii, uniform +- (0 = perfect)
  std::string shape = "disk";      ///< disk | regular (polygons) | irregular (layered: pentagons;
                                   ///< `sizes` is not used);
                                   ///< 3D: disk (spheres) | superellipsoid (random), in `sizes`
  int corners = 24;                ///< regular: on the circle of the radius
  double side = 0.009;             ///< m; irregular: mean length of a side (Roul 5.1)
  std::string sides = "periodic";  ///< 3D: periodic | walls
  std::string stacking = "fcc";    ///< 3D, close_packed: fcc (ABC) | hcp (AB)
  double axis_min = 0.7;           ///< superellipsoid: semi-axes over the radius
  double axis_max = 1.3;
  double exponent_min = 0.7;  ///< superellipsoid
  double exponent_max = 1.3;

  auto members() const {
    return std::tie(dim, kind, sizes, radius, radius_small, fraction_small, radius_min, radius_max,
                    columns, rows, spacing, width, depth, drop_height, floor, jitter, shape, side,
                    sides, stacking, axis_min, axis_max, exponent_min, exponent_max, corners);
  }
};

/// Throws std::invalid_argument naming the key ("packing.radius_max"), the value and what is
/// allowed.
void check_packing(const PackingSetup& packing);

/// Radius of the next grain, m: mono, bidisperse (by number) or uniform in [radius_min,
/// radius_max].
double draw_radius(const PackingSetup& packing, Random& random);
/// Bounds of the radii, of pentagons: of their circumscribed and inscribed circles.
double largest_radius(const PackingSetup& packing);
double smallest_radius(const PackingSetup& packing);
/// m; of pentagons that of the circle their corners lie on, about.
double mean_radius(const PackingSetup& packing);

/// Whether the grains are pentagons, drawn before the layer is built, and how many are drawn.
bool draws_pentagons(const PackingSetup& packing);
double pentagons_drawn(const PackingSetup& packing);
/// Their family.
ShapeSetup pentagon(const PackingSetup& packing);

/// Distance between the side walls, m.
double layer_width(const PackingSetup& packing);

/// Floor, left and right wall with their friction.
std::vector<Wall> layer_walls(const PackingSetup& packing, const MaterialSetup& material);

/// A grain of this radius: a disk, or a regular polygon with its corners on that circle, turned at
/// random.
ShapedGrain round_grain(const PackingSetup& packing, double radius, Random& random);

/// The grains of a packing in the order they are used. Disks and regular polygons are drawn when
/// they are asked for.
/// Pentagons are drawn beforehand, more than the layer can hold, so that the time step can be
/// chosen for exactly these.
class GrainSupply {
 public:
  static constexpr double kMostDrawn = std::numeric_limits<double>::infinity();
  /// Draws at most `most` pentagons.
  GrainSupply(const PackingSetup& packing, Random& random, double most = kMostDrawn);

  /// The next grains, as many as fit side by side into the width by their bounding circles. Throws
  /// ComputationFailed when the supply is used up.
  std::vector<ShapedGrain> fill(double width, Random& random);
  GrainExtremes extremes(double density) const;

  long taken() const { return taken_; }
  void set_taken(long taken) { taken_ = taken; }

 private:
  PackingSetup packing_;
  std::vector<ShapedGrain> drawn_;
  long taken_ = 0;
};

/// The fixed grains of a rough floor, their bounding circles' tops at y = 0: under a lattice a row
/// of it, under a layered packing grains like its own side by side from wall to wall. Empty for a
/// smooth floor.
std::vector<NewGrain> floor_grains(const PackingSetup& packing, GrainSupply& supply, double density,
                                   Random& random);

/// All grains of a lattice, touching and without overlap (regular polygons: their circles).
/// triangular: rows offset by half a diameter, six neighbours; odd rows have one grain less.
/// sqrt3 (Roul 5.4): spacing sqrt(3) d in a row, rows offset by half of it and d/2 apart, so that a
/// grain touches four others at +-30 degrees from the horizontal and none in its row. At exactly
/// sqrt(3) d rows two apart touch as well (it is the triangular lattice turned by 30 degrees); a
/// spacing below 1 lifts the rows apart and leaves the four contacts that Roul describes.
std::vector<NewGrain> lattice_grains(const PackingSetup& packing, double density, Random& random);

/// One row to drop: grains side by side with random gaps from wall to wall, their lowest points at
/// height y.
std::vector<NewGrain> row_of_grains(const PackingSetup& packing, GrainSupply& supply,
                                    double density, double y, Random& random);

/// Height of the free surface, m: mean over vertical strips four mean radii wide of the highest
/// grain top. 0 without free grains.
double surface_height(const Snapshot& snapshot, double width);

}  // namespace grainfield::dem
