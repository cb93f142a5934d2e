// Grains and contacts to fields on points, by interchangeable weights (docs/averaging.md).
#pragma once
#include <Eigen/Core>
#include <string>

#include "coupling/averaging/layer.h"
#include "coupling/field.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct AverageOptions {
  std::string method = "coarse_graining";  ///< coarse_graining | particle_centre
  /// coarse_graining: lucy | gaussian | heaviside; particle_centre: circle | square
  std::string kernel = "lucy";
  /// m. coarse_graining: w of the kernel (lucy ends at 2 w, gaussian at 3 w, heaviside at w);
  /// particle_centre: radius of the circle or half the side of the square.
  double width = 0;
  /// coarse_graining: true carries the force of a wall or fixed grain straight on into the wall, so
  /// that the stress reaches the wall's value at the wall and traction_* vanishes in the layer;
  /// false ends the branch at the contact point and gives traction_* there (Weinhart et al. 2012).
  bool extend_into_walls = true;
  int least_grains = 3;  ///< fewer grains than this in the support: nan there
  int threads = 1;       ///< the bits do not depend on it
};

/// Fields of one snapshot at `points` (n x 2, packing's axes, m). Columns, tension positive:
///   sigma_xx sigma_yy sigma_xy sigma_yx (N/m; sigma_ab: force a, branch b; contact part),
///   kinetic_xx kinetic_yy kinetic_xy (N/m), density (kg/m2), volume_fraction (1),
///   traction_x traction_y, load_x load_y (N/m2: force densities of walls and of the applied
///   force), grains (1: centres in the support). Fixed grains belong to the apparatus: they are not
///   counted.
/// coarse_graining obeys div sigma + density g + traction + load = 0 up to the grains' unbalanced
/// forces. Throws std::invalid_argument for bad options, 3D snapshots or points of another width.
Field average(const dem::Snapshot& snapshot, const Eigen::MatrixXd& points,
              const AverageOptions& options);

/// average(loaded) - average(unloaded), column by column; `grains` is the smaller count. Throws
/// std::invalid_argument "snapshots do not belong together: ..." unless both hold the same grains.
Field response(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
               const Eigen::MatrixXd& points, const AverageOptions& options);

/// Throws std::invalid_argument "snapshots do not belong together: ..." unless both hold the same
/// grains by id, radius, outline and fixedness, and the same walls.
void require_same_grains(const dem::Snapshot& unloaded, const dem::Snapshot& loaded);

/// How well an averaging obeys div sigma + density g + traction + load = 0 at the points.
struct BalanceResidual {
  double rms = 0;      ///< root mean square over the points and both components, over rho g
  double largest = 0;  ///< largest length of the residual vector, over rho g
  double rho_g = 0;    ///< the scale: mean density of the evaluated points times |gravity|, N/m2
  double step = 0;     ///< of the finite differences, m
  int points = 0;      ///< evaluated: those whose whole stencil has values
};

/// Differentiates the averaged stress itself with fourth-order central differences. step 0 takes
/// 0.05 width for coarse_graining and half the width for particle_centre (whose field jumps when a
/// centroid enters: a smaller step only shows the jumps). Throws as average().
BalanceResidual balance_residual(const dem::Snapshot& snapshot, const Eigen::MatrixXd& points,
                                 const AverageOptions& options, double step = 0);

/// n equally spaced points from x0 to x1 at height y; n x 2.
Eigen::MatrixXd line_points(double x0, double x1, int n, double y);
/// nx x ny grid, x fastest, as Field::points wants it.
Eigen::MatrixXd grid_points(double x0, double x1, int nx, double y0, double y1, int ny);

}  // namespace grainfield::coupling
