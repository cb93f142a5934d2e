// Finite elements of heaps with measured and fitted constants.
#pragma once
#include <string>
#include <vector>

#include "coupling/fit/finite_elements.h"
#include "coupling/fit/heap_report.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// fe_osl_wedge with eta and mu of the better of osl and osl_yield; fe_mohr_coulomb_wedge with the
/// measured slope as friction angle, laid in layers along the slopes, beside the best of the
/// cantelaube_* fields without free core. Without such a fit, or where the solve fails, `why` says
/// so.
std::vector<FiniteElementFit> heap_elements(const HeapFits& fits,
                                            const std::vector<std::string>& names);

/// Their keys and, in fits.md and the page, their table.
void add_heap_elements(StudyResult& result, const std::vector<FiniteElementFit>& elements);

}  // namespace grainfield::coupling
