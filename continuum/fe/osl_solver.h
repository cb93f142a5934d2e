// Oriented stress linearity by a discontinuous Galerkin method; this header does without deal.II.
//
// On every cell K, with tensor-product polynomials u, t of degree p on the mapped square,
//   - int_K (u . dt/dy + A u . dt/dx) + int_dK F(u, n) . t = int_K b . t,
// F the upwind flux along the characteristics (continuum/osl/flux.h). No stress travels upwards, so
// the rows of the mesh are solved one after the other from the surface down; within a row, where
// stress travels to both sides, the matrix is block tridiagonal and is eliminated block by block.
// Work and memory are linear in the unknowns. With t = 1 every cell, and so the whole, is in
// balance of forces to round-off.
#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>

#include "continuum/osl/problem.h"

namespace grainfield::continuum::fe {

class OslSolver {
 public:
  /// Throws BadParameter when the mesh does not fit (osl::check_mesh) and for an order outside 0 to
  /// kMostOrder.
  OslSolver(osl::Problem problem, osl::StripMesh mesh, int order);
  ~OslSolver();
  static constexpr int kMostOrder = 8;

  /// Throws BadParameter where the fields leave the hyperbolic range or, on a slope, where a
  /// characteristic leaves the heap; ComputationFailed when a row is not solved to round-off.
  void solve();
  /// (syy, sxy) at a place of the mesh; nan outside.
  osl::State at(double x, double depth) const;
  /// L2 norms over the mesh of the errors of syy and sxy.
  Eigen::Vector2d errors(const osl::StateField& exact) const;
  /// unknowns, cells; base_force, side_force (the part of the weight that leaves through the
  /// sides), weight, load (all vertical, N per metre of width); force_balance: their imbalance over
  /// the largest of them; residual: the worst row's; seconds as solve_s.
  const std::map<std::string, double>& figures() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace grainfield::continuum::fe
