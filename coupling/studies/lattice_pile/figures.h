// Figures of lattice piles.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/output/figure.h"
#include "coupling/run/measured_base.h"

namespace grainfield::coupling {

/// N down and H to the right on every base disk, N.
struct BaseForces {
  Eigen::VectorXd normal, horizontal;
};

/// A lattice pile as all realizations together tell it.
struct LatticeFacts {
  int rows = 0, base_grains = 0;
  double weight = 0;          ///< of a disk, N
  double stiffness = 0;       ///< times the diameter, N
  BaseForces grains;          ///< means over the realizations
  BaseForces lattice, lines;  ///< by the closed form of hard disks, and by the line model
  BaseProfile profile, line_profile;

  bool pushes_sideways() const { return grains.horizontal.cwiseAbs().maxCoeff() > 0; }
};

/// Their rows in summary.json; those without a function are means of add_samples.
const std::vector<RunFigure<LatticeFacts>>& lattice_rows();

}  // namespace grainfield::coupling
