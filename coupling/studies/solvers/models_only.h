// Models against each other at points of a plane, without grains: what the studies of continuum
// solvers share.
#pragma once
#include <vector>

#include "coupling/case/case.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/solvers/setup.h"

namespace grainfield::coupling {

/// Where a study without grains looks.
struct ModelsOnly {
  RunFacts facts;              ///< dim 3: points lie in the plane y = 0
  double load = 0;             ///< N: stresses are counted in load / facts.height
  std::vector<double> depths;  ///< m, of the profiles
  double half_width = 0;       ///< m, of profiles and map
  int points = 0;              ///< of a profile
};

/// Throws std::invalid_argument, "KEY: ...", for depths below the base.
void require_depths(const ProblemSetup& setup);

/// Profiles of the vertical pressure at the depths, and a map that leaves out the uppermost tenth.
/// The first model takes the place of the simulation in the tables, the others are compared with
/// it. Throws what models throw.
StudyResult compare_models(const Case& value, const std::vector<ModelChoice>& choices,
                           const ModelsOnly& where);

}  // namespace grainfield::coupling
