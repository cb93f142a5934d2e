// Roul's fits of chapter 4 and his comparison of asymmetric piles, as figures of the page.
#pragma once
#include <vector>

#include "coupling/reproduce/figures.h"

namespace grainfield::coupling {

/// In the order of the page. Errors are the larger of the fit's own (the jackknife's) and the
/// bootstrap's.
std::vector<SourceFigure> fit_figures();

/// "within the errors: chi2/dof 1.08 ..." or "beyond the errors: ...": beyond when chi2/dof exceeds
/// `most`, which a true model exceeds in about 1 of 100 (Fit::chance).
std::string fit_word(double chi2_per_dof, double most, double rel_l2);

}  // namespace grainfield::coupling
