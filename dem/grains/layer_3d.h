// Layers of spheres or superellipsoids: where grains, floor and sides of a layer in three
// dimensions start. Up is z, the floor's surface is z = 0, and the layer is centred about x = y =
// 0.
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/grains/packing.h"
#include "dem/random/random.h"
#include "dem/space/cell.h"

namespace grainfield::dem {

/// Solid fraction that a settled layer is taken to have when its grains are counted out.
inline constexpr double kSettledFraction = 0.55;

/// As check_packing, of packing.dim = 3.
void check_layer_3d(const PackingSetup& packing);

/// Superellipsoids instead of spheres.
bool is_angular(const PackingSetup& packing);

/// Mean of the radii that draw_radius gives, m, and mean volume of the grains, m3.
double mean_sphere_radius(const PackingSetup& packing);
double mean_sphere_volume(const PackingSetup& packing);
/// The farthest point of a grain from its centre that can be drawn, m.
double farthest_reach(const PackingSetup& packing);

/// Grains of a random layer in the order in which they are drawn, as many as fill packing.depth at
/// kSettledFraction, while another one `may_follow`.
std::vector<ShapedGrain> draw_layer(
    const PackingSetup& packing, Random& random,
    const std::function<bool()>& may_follow = [] { return true; });

/// Lengths of the layer along x and y, m: packing.width both; of a close packing those of its
/// lattice, whose rows along y are even in number and make it as square as they can.
std::array<double, 2> layer_sides(const PackingSetup& packing);
/// Free spheres of the layer, about, and fixed ones of its floor.
double layer_spheres(const PackingSetup& packing);
double floor_spheres(const PackingSetup& packing);
/// Height of the box in which spheres are placed at random before they settle, m.
double loose_height(const PackingSetup& packing);

/// Periodic along x and y with packing.sides = "periodic", else without an axis.
Cell<3> layer_cell(const PackingSetup& packing);
/// The plane "floor" (below a rough floor out of reach), and "left", "right" (x), "front", "back"
/// (y) of packing.sides = "walls".
std::vector<Wall> walls_3d(const PackingSetup& packing, const MaterialSetup& material);

/// The fixed spheres of a rough floor with their tops at z = 0; none of a smooth one. Under a close
/// packing a layer of it; else rows that leave no gap for a free grain, radii as the layer's or,
/// where a small grain would pass between small ones, the largest.
std::vector<NewGrain> floor_3d(const PackingSetup& packing, double density, Random& random);

/// The free spheres. random: apart from each other in a box loose_height() high above the floor, as
/// many as fill packing.depth at kSettledFraction. close_packed: packing.rows layers, densest in
/// the horizontal plane, in the order ABC (fcc) or AB (hcp), touching without overlap (jitter:
/// smaller spheres at the same places).
std::vector<NewGrain> grains_3d(const PackingSetup& packing, double density, Random& random);
/// Those of a random layer, drawn before.
std::vector<NewGrain> place_layer(const PackingSetup& packing,
                                  const std::vector<ShapedGrain>& drawn, double density,
                                  Random& random);

/// Height of the free surface, m: mean over columns two mean diameters wide of the highest top. 0
/// without free grains.
double surface_3d(const Snapshot& snapshot, const PackingSetup& packing);

}  // namespace grainfield::dem
