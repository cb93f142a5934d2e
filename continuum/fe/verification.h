// The finite-element solver on problems whose solution is known: for tests and benchmarks.
#pragma once
#include <map>
#include <string>
#include <vector>

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

}  // namespace grainfield::continuum
