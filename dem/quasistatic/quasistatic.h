// Quasi-static relaxation: a packing is carried to equilibrium by an implicit solver on its contact
// network instead of by damped dynamics.
//
// Unknowns: centroids and angles of the free grains. Residual: contact forces of the law without
// its dashpots (tangential spring advanced from its stored value by the increment of slip, capped
// by Coulomb), gravity and the applied force. Newton's method with KINSOL, the tangent stiffness
// with stick and slip assembled per contact and factorized sparse; loads in adaptive steps.
#pragma once
#include <functional>
#include <stdexcept>
#include <vector>

#include "dem/laws/materials.h"
#include "dem/motion/applied_force.h"
#include "dem/shared/computation_failed.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

struct QuasistaticSettings {
  /// To be reached: mean resultant / mean contact force, and mean |moment| / radius likewise.
  double unbalanced_force_ratio = 1e-8;
  int max_iterations = 50;   ///< Newton steps of one load step
  int first_steps = 1;       ///< equal load steps to begin with; halved when one fails
  double least_step = 1e-3;  ///< share of the whole change below which it gives up
  /// Asked before every Newton solve, with the share of the change that is done; false: give up
  /// with RelaxationStopped. Empty: never asked.
  std::function<bool(double share)> go_on;
};

/// go_on said no.
struct RelaxationStopped : std::runtime_error {
  RelaxationStopped() : std::runtime_error("quasi-static relaxation stopped") {}
};

struct QuasistaticResult {
  Snapshot state;                      ///< at rest: velocities are 0, springs are kept
  double unbalanced_force_ratio = 0;   ///< reached
  double unbalanced_moment_ratio = 0;  ///< reached: mean of |moment| / radius, likewise
  int steps = 0, iterations = 0;
  int times_apart = 0;  ///< that loose grains were settled apart from the others
  int contacts_gained = 0, contacts_lost = 0, newly_sliding = 0;  ///< against the start
};

/// The packing `start` at rest under the gravity and the force given, which the grains `beside`
/// carry each, too (start.applied_force is replaced). `materials`: contact law and friction of the
/// grains, one for all; walls keep their own friction. Throws std::invalid_argument for a start
/// that does not fit, and ComputationFailed saying how far it came (share of the change, ratio
/// reached) and what to try.
QuasistaticResult relax(const Snapshot& start, const Materials& materials, const Vec3& gravity,
                        const AppliedForce& force, const QuasistaticSettings& settings,
                        const std::vector<std::int64_t>& beside = {});

/// The packing `start`, under its own gravity and force, after a small homogeneous
/// strain: everything moves by gradient * x (x in the packing's axes), then the free grains relax,
/// while fixed grains keep the place and the orientation that the strain gave them and the edges of
/// the cell theirs. state.cell is the strained one. Throws as relax(), and std::invalid_argument
/// for a free grain at a wall, or a gradient that is not small (0.01).
QuasistaticResult strain(const Snapshot& start, const Materials& materials,
                         const Eigen::Matrix3d& gradient, const QuasistaticSettings& settings);

}  // namespace grainfield::dem
