// What two snapshots say about the motion of the free grains: the input of every strain measure.
#pragma once
#include <Eigen/Core>
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Rows: free grains, or contacts between two free grains; columns: axes (2 or 3).
struct GrainMotion {
  int dim = 2;
  Eigen::MatrixXd position;      ///< centroids before, m
  Eigen::MatrixXd displacement;  ///< of the centroids, m
  Eigen::VectorXd mass;          ///< kg

  Eigen::MatrixXd contact_point;  ///< before, m
  Eigen::MatrixXd branch;         ///< l = r_pc - r_qc, from the centroid of p to that of q, m
  Eigen::MatrixXd relative;       ///< du_q - du_p (Roul 2.52), m
  Eigen::MatrixXd slip;           ///< the same of the two bodies' points at the contact: with spins
                                  ///< (Roul 2.69), m
  bool turns = true;              ///< false: spheres of which no state tells an orientation
  std::string images, doubt;      ///< of dem::Displacements between the two states
};

/// Turns of the grains are taken modulo a full turn, nearest to zero; of spheres as the vector
/// along the axis of the turn from one orientation to the other. Throws std::invalid_argument as
/// require_same_grains().
GrainMotion grain_motion(const dem::Snapshot& before, const dem::Snapshot& after);

}  // namespace grainfield::coupling
