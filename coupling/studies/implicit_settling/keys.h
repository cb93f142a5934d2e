// The section of piles that settle under implicit motion, and their figures.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/case/study.h"
#include "coupling/result/figure.h"
#include "coupling/run/recorded.h"

namespace grainfield::coupling {

void declare_settling_keys(SectionKeys s);

inline constexpr KeySection kSettlingKeys{"settling", KeyRole::grains, declare_settling_keys};

/// Keys of its figures in summary.json.
std::vector<SummaryKey> settling_figures();

/// The first realization: the lattice is perfect, and all are alike.
struct SettlingFacts {
  Eigen::VectorXd normal, horizontal;            ///< N and H of the base disks, m g
  Eigen::VectorXd hard_normal, hard_horizontal;  ///< by the closed form of hard disks
  const RecordedColumns& columns;
};
const std::vector<RunFigure<SettlingFacts>>& settling_rows();

}  // namespace grainfield::coupling
