// The finite-element solver on problems whose solution is known: for tests and benchmarks.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "continuum/closed/orthotropic.h"

namespace grainfield::continuum {

/// Errors of one solve on a mesh of cubes of edge 2^-refinement.
struct ManufacturedErrors {
  double displacement = 0;  ///< L2 norm of u - u_h
  double stress = 0;        ///< L2 norm of sigma - sigma_h, direct from the gradient of u_h
  double recovered = 0;     ///< the same for the recovered, continuous stress
  std::map<std::string, double> figures;  ///< as Model::figures()
};

/// Solves div sigma + f = 0 on the unit square or cube with f, displacements on all sides but the
/// upper one and the traction there such that u is a known product of sines and cosines; E = 1.
/// dim 2 or 3, degree >= 1. `mixed` refines a corner once more, so that the mesh has hanging nodes.
/// Throws ComputationFailed.
ManufacturedErrors solve_manufactured(int dim, int degree, double nu, int refinement,
                                      bool mixed = false);

/// The same in 2D with orthotropic constants: `uniform`, or C(x, y) = (1 + sin(x + 2 y + 0.3)/3)
/// C_0 with an initial stress. Of the unit square's sides the left one is held, the lower one
/// smooth, the right one on springs, the upper one under its traction. `stress` and `recovered` are
/// of C eps, without the initial stress.
ManufacturedErrors solve_manufactured_map(int degree, const PlaneModuli& moduli, int refinement,
                                          bool uniform);

/// Plane strain on a unit square whose upper side is 0.05 below a point load on a half plane
/// (Flamant), F = E = 1, nu = 0.3, with the exact displacement on all its sides, on cells x cells
/// squares: what tests/benchmarks/against_fe_peers.sh gives to other programs too. With dim 3 a
/// unit cube below a point load on a half space (Boussinesq), on cells^3 cubes. Throws
/// ComputationFailed.
ManufacturedErrors solve_below_load(int dim, int degree, int cells);

}  // namespace grainfield::continuum
