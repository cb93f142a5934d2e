// Displacement gradients on points from two snapshots of the same grains (docs/strain.md).
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/base/field.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct StrainOptions {
  /// cambou | cundall | liao | derivative | kernel (Roul 2.6.2; kernel: docs/strain.md)
  std::string measure = "cambou";
  /// m. Radius of the circle or half the side of the square around the point; measure kernel: w of
  /// the kernel (lucy ends at 2 w, gaussian at 3 w).
  double width = 0;
  /// circle | square (in 3D: ball, cube); measure kernel: lucy | gaussian
  std::string support = "circle";
  /// m. Measure derivative: distance of the neighbouring elements along each axis; 0: the width.
  double step = 0;
  /// derivative: true takes (element ahead - element at the point) as Roul 2.76, first order in the
  /// step; false the central difference, second order.
  bool forward = false;
  /// derivative and kernel: true relates changes of the mean displacement to changes of the mean
  /// position of the same grains, which gives an affine displacement back exactly; false to the
  /// nominal distance (Roul 2.76, and the plain gradient of the coarse-grained displacement), which
  /// errs by the disorder of the grains.
  bool affine_exact = true;
  /// Fewer grains than this in the support (for derivative: in an element): nan.
  int least_grains = 6;
  /// Larger ratios of the extreme singular values of the matrix (largest over smallest spread of
  /// the branches or positions) count as degenerate: nan. Grains in a row have infinity, a round
  /// neighbourhood 1 to 2.
  double largest_condition = 30;
  int threads = 1;  ///< the bits do not depend on it
};

struct StrainResult {
  /// Columns in 2D (3D: with z): u_x u_y (m: mean displacement of the grains in the support),
  /// du_x_dx du_x_dy du_y_dx du_y_dy (1: displacement gradient), strain_xx strain_yy strain_xy (1:
  /// its symmetric part, extension positive), rotation (1: (du_y/dx - du_x/dy)/2, counter-clockwise
  /// positive; 3D: rotation_x, _y, _z), grains, contacts (1: used; contacts is 0 for measures that
  /// use none), condition (1), misfit (1: root mean square of what the gradient leaves over that of
  /// the data, 0 = affine; nan for derivative).
  Field field;
  std::vector<Eigen::Index> too_few;     ///< points with nan for want of grains or contacts
  std::vector<Eigen::Index> degenerate;  ///< points with nan for want of rank or condition
  std::string images, doubt;             ///< as GrainMotion has them

  /// One line: how many points have no strain and why, with the first of each; "" if all have.
  std::string report() const;
};

/// Small displacements `after` - `before`, gradients against the positions `before`; contacts are
/// those of `before`. Fixed grains and walls belong to the apparatus and give nothing. `points`: n
/// x 2 (3D: n x 3), m. Throws std::invalid_argument "snapshots do not belong together: ..." unless
/// both hold the same grains (id, radius, outline, fixedness), for bad options, and for measure
/// liao where no 3D snapshot tells an orientation.
StrainResult strain(const dem::Snapshot& before, const dem::Snapshot& after,
                    const Eigen::MatrixXd& points, const StrainOptions& options);

/// cambou, cundall, liao, derivative, kernel.
const std::vector<std::string>& strain_measures();

}  // namespace grainfield::coupling
