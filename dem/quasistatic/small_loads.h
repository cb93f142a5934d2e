// Small loads on single grains of a packing at rest change it to first order: one tangent
// stiffness, factorized once, and one right-hand side a load.
//
// No contact opens, closes or begins to slide under such a load: contacts that slide go on sliding,
// all others stick. The floor that keeps factors regular (ContactNetwork::kFloor) is taken out
// again by iteration: z += J^-1 (f + T z) with the tangent T without it.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "dem/quasistatic/contact_network.h"
#include "dem/quasistatic/linear_solver.h"
#include "dem/quasistatic/quasistatic.h"

namespace grainfield::dem {

struct SmallResponse {
  std::vector<Vec3> moved;   ///< displacement of each grain, m; fixed ones: 0
  std::vector<Vec3> turned;  ///< rotation, rad
  /// The packing where it was, without gravity, under the load; contacts carry the changes of their
  /// forces. Their normal force is the change along the normal, repulsion positive.
  Snapshot change;
  double left = 0;  ///< share of the load that is out of balance: largest resultant over the load
  int solves = 0;   ///< with the factors
};

class SmallLoads {
 public:
  /// `start`: at rest to a ratio of 1e-4 or better; `materials` must outlive this. Throws
  /// std::invalid_argument as relax(), and ComputationFailed for a packing that is not at rest or
  /// has no contact.
  SmallLoads(const Snapshot& start, const Materials& materials);

  const Snapshot& start() const { return start_; }
  /// `force`, N, on each of the grains with these ids; linear in it. Throws std::invalid_argument
  /// for other than free grains, and ComputationFailed where nothing carries the load (a loose
  /// grain).
  SmallResponse response(const std::vector<std::int64_t>& ids, const Vec3& force);

 private:
  using Vector = ContactNetwork::Vector;
  /// z of this right side, T z = -rhs.
  Vector solve(const Vector& rhs, SmallResponse& out);

  Snapshot start_;
  std::unique_ptr<ContactNetwork> network_;
  ContactNetwork::Matrix tangent_, factorized_;  // T, and J with the floor
  std::unique_ptr<LinearSolver> solver_;
};

}  // namespace grainfield::dem
