// What every averaging is asked: does its field carry the weight?
#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "coupling/averaging/options.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// How well an averaging obeys div sigma + density g + traction + load = 0 at the points.
struct BalanceResidual {
  double rms = 0;      ///< root mean square over the points and components, over rho g
  double largest = 0;  ///< largest length of the residual vector, over rho g
  double rho_g = 0;    ///< the scale: mean density of the evaluated points times |gravity|, N/m2
  double step = 0;     ///< of the finite differences, m
  int points = 0;      ///< evaluated: those whose whole stencil has values
};

/// Differentiates the averaged stress (with its kinetic part) itself by central differences of
/// `order` 2 or 4. step 0 takes 0.05 width for coarse_graining and half the width for the RVE
/// methods (particle_centre jumps when a centroid enters: a smaller step only shows the jumps).
/// Throws as average().
BalanceResidual balance_residual(const dem::Snapshot& snapshot, const Eigen::MatrixXd& points,
                                 const AverageOptions& options, double step = 0, int order = 4);

/// Vertical force through one horizontal cut, N, pushing down. Vertical is y, in space z.
struct CutForce {
  double height = 0;  ///< of the cut, m
  double force = 0;   ///< - integral of (sigma_yy + kinetic_yy) along (over) the cut
  double weight = 0;  ///< the weight above, and what walls and load take or add above, as the
                      ///< averaging sees it: smeared with the same weight over the height
  double sharp = 0;   ///< weight_above(height)
  double error() const { return force / weight - 1; }
};

/// Integrates the averaged field itself along the cut at height y with a midpoint rule of spacing
/// `step` (0: width / 40, in space a ninth of a kernel's range or a sixth
/// of an element's width, and not more than 400,000 places); along an axis that repeats over
/// exactly one period. coarse_graining: along the whole line, and `weight` is the weight smeared
/// with the kernel, exact for packings in equilibrium. The RVE methods: between the packing's ends,
/// over the points with a value, and `weight` is weight_above, where the contacts carry it through
/// each height, averaged over the part of the RVE inside the packing. Throws as average().
CutForce cut_force(const dem::Snapshot& snapshot, double y, const AverageOptions& options,
                   double step = 0);

/// Weight of the (parts of) free grains above y, less the vertical force that walls give them above
/// y, plus the applied force if its grain's centre is above; N. Fixed grains act at the floor's
/// mean height.
double weight_above(const dem::Snapshot& snapshot, double y);

/// One line of the table that puts the averagings side by side.
struct BalanceRow {
  std::string method, kernel;
  double width = 0;                       ///< m
  BalanceResidual base, inside, surface;  ///< within one mean diameter of the floor, between,
                                          ///< within one mean diameter of the free surface
  double worst_cut = 0;                   ///< CutForce::error() of the cut where it is largest
  double worst_sharp = 0;                 ///< the same against CutForce::sharp
};

/// Every method with each of its kernels (coarse graining without and with extension into the
/// walls would differ only in where the traction is: `options` decides). Widths: `options.width`
/// mean diameters for the kernels' w, and RVEs of 2.5 times as much. Cuts at 0,
/// 0.1, ..., 0.8 of the height. Throws as average(), and std::invalid_argument for a packing less
/// than four mean diameters high or without gravity along -y (-z), or that repeats along it. In
/// space the points reach from side to side. `progress` (may be empty) is told the share of the
/// work that is done.
std::vector<BalanceRow> balance_table(const dem::Snapshot& snapshot, AverageOptions options,
                                      const std::function<void(double)>& progress = {});

}  // namespace grainfield::coupling
