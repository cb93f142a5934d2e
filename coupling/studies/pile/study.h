// Piles of grains: base pressure and dip, cuts, maps of stress and volume fraction, over an
// ensemble of piles of slightly different height.
#pragma once
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/case/study.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// Averages the snapshot "pile" of the finished realizations (files of run_tasks, in order), each
/// in its own scaled frame (pile_frame.h) and in units of its own rho g h, and compares with the
/// case's models, if there are any. Every further snapshot is the same pile under another gravity.
/// The bits do not depend on `threads`. Throws what averaging and models throw.
StudyResult analyse_pile(const Case& value, const std::vector<std::string>& realizations,
                         int threads);

Study pile_study();

}  // namespace grainfield::coupling
