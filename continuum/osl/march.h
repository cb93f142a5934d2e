// Oriented stress linearity by marching in depth: the second solver, independent of the finite
// elements.
//
// Method of lines: the force content W_i = int u dx of every column is carried from the surface
// down,
//   dW_i/dy = -[(A - dX/dy) u]_left^right + int (w, v) dx,
// X(y) the columns' borders (a heap's columns are rays and widen with depth). States at the borders
// are reconstructed from the contents of three neighbouring columns (third order, none across the
// axis or the mesh's kinks) and split upwind along the characteristics. ARKode (SUNDIALS)
// integrates with an explicit Runge-Kutta method of fourth order, steps limited by error and by the
// characteristics' speed.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "continuum/osl/problem.h"

namespace grainfield::continuum::osl {

struct MarchSettings {
  double tolerance = 1e-9;  ///< relative, of the depth integration
  long most_steps = 1000000;
};

struct MarchResult {
  std::vector<State> states;  ///< at the points, in their order; nan outside of the mesh
  /// unknowns, steps; base_force, side_force, weight, load, force_balance as of the finite elements
  /// (OslSolver::figures); solve_s.
  std::map<std::string, double> figures;
};

/// Marches from the surface to mesh.rows.back(); of the rows only that matters. `points` are (x,
/// depth) in rows. Throws BadParameter as OslSolver does, ComputationFailed when ARKode stops.
MarchResult march(const Problem& problem, const StripMesh& mesh, const Eigen::MatrixXd& points,
                  const MarchSettings& settings = {});

}  // namespace grainfield::continuum::osl
