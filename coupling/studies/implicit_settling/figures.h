// Figures of lattice piles that settle.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/output/figure.h"
#include "coupling/run/recorded.h"

namespace grainfield::coupling {

/// The first realization: the lattice is perfect, and all are alike.
struct SettlingFacts {
  Eigen::VectorXd normal, horizontal;            ///< N and H of the base disks, m g
  Eigen::VectorXd hard_normal, hard_horizontal;  ///< by the closed form of hard disks
  const RecordedColumns& columns;
};
const std::vector<RunFigure<SettlingFacts>>& settling_rows();

}  // namespace grainfield::coupling
