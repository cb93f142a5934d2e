// Oriented stress linearity as a field problem (Wittmer, Cates and Claudin 1997; Roul 4.4):
//   d/dy syy + d/dx sxy = w,   d/dy sxy + d/dx sxx = v,   sxx = eta syy + mu sgn(x) sxy,
// y down, compression positive; w is the weight of a unit volume, v (usually none) a horizontal
// body force, eta and mu may vary. With u = (syy, sxy) this is
//   du/dy + d(A u)/dx = (w, v),   A = (0, 1; eta, mu sgn(x)),
// hyperbolic with depth in the place of time: stress travels down along dx/dy = lambda, the
// eigenvalues of A, lambda^2 - mu sgn(x) lambda - eta = 0, with eigenvectors (1, lambda).
#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace grainfield::continuum::osl {

/// (syy, sxy), compression positive, y down, Pa (2D: N/m).
using State = Eigen::Vector2d;
using Matrix = Eigen::Matrix2d;
/// A value at (x, depth), m.
using Field = std::function<double(double x, double depth)>;
using StateField = std::function<State(double x, double depth)>;

/// What a layer's sides do.
enum class Sides {
  far,    ///< the layer goes on: stress leaves, and what comes in is that of Problem::beyond
  walls,  ///< rigid walls that carry |sxy| = wall_friction sxx downwards; 0: smooth, they reflect
};

struct Problem {
  std::string name;          ///< begins the messages of failures
  Field weight;              ///< N/m^3 (2D: N/m^2), downwards
  Field eta, mu;             ///< 1
  bool mirrored = true;      ///< mu counts with the sign of x; false: as it is
  Field side_force = {};     ///< N/m^3, to the right; none = 0
  StateField surface = {};   ///< stress on the free surface (slopes, top); none = 0
  Sides sides = Sides::far;  ///< of a layer
  double wall_friction = 0;  ///< sides = walls
  StateField beyond = {};    ///< sides = far: the stress beyond; none = 0
};

/// Horizontal rows of quadrilaterals: node (i, j) is at depth rows[j] and x = columns[i] (layer) or
/// x = columns[i] * spread * depth (heap: columns are rays from the apex, -1 and 1 the slopes).
struct StripMesh {
  std::vector<double> columns, rows;
  double spread = 0;  ///< cot of the slope; 0: x = columns[i]
  /// Those of the columns' borders along which derivatives of the stress jump.
  std::vector<double> kinks = {};

  double x(double column, double depth) const {
    return spread > 0 ? column * spread * depth : column;
  }
  /// The column's coordinate of x at this depth (not at a heap's apex).
  double column(double x_at, double depth) const {
    return spread > 0 ? x_at / (spread * depth) : x_at;
  }
  int columns_count() const { return static_cast<int>(columns.size()) - 1; }
  int rows_count() const { return static_cast<int>(rows.size()) - 1; }
};

/// Throws BadParameter naming what does not fit: fewer than one cell, nodes that do not ascend, the
/// first row not at depth 0, rays that do not end on the slopes, no column border at x = 0 although
/// the closure is mirrored.
void check_mesh(const Problem& problem, const StripMesh& mesh);

/// A heap with n columns on either side of the axis. `characteristic` > 0: dx/dy of the
/// characteristic from the apex, which becomes a border; 0: rays at equal distances. Throws
/// BadParameter for n < 2 with a characteristic.
StripMesh heap_mesh(double spread, double depth, int n, int rows, double characteristic);
/// A layer, or a heap's bounding box, of equal columns and rows.
StripMesh box_mesh(double half_width, double depth, int n, int rows);

}  // namespace grainfield::continuum::osl
