// Lattice piles: the forces of every base disk beside Liffman's closed forms.
#pragma once
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/case/study.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// N and H of the base disks of the finished realizations (files of run_tasks, in order; means)
/// against the closed form of hard close-packed disks, the line model, and the case's models.
/// Throws what models throw.
StudyResult analyse_lattice_pile(const Case& value, const std::vector<std::string>& realizations,
                                 int threads);

Study lattice_pile_study();

}  // namespace grainfield::coupling
