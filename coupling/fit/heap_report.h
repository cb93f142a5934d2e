// What fits of heaps leave: summary keys, tables and pictures.
#pragma once
#include <string>
#include <vector>

#include "coupling/fit/heap_fits.h"
#include "coupling/output/tables.h"
#include "coupling/report/report.h"

namespace grainfield::coupling {

/// fit.MODEL.*, fit.* and verdict.*: see figures.cc.
void add_fits(Summary& summary, const HeapFits& fits);

/// The branch of Cantelaube's theory whose core angle is nearest: "minus", "zero" or "plus".
std::string nearest_branch(double slope_deg, double beta_hat_deg);

/// Parameters and ranking, as a Markdown document and as LaTeX tables.
std::string fits_markdown(const HeapFits& fits);
std::string fits_tex(const HeapFits& fits);

/// Pictures first: profiles of every component with the best models, residuals; then the tables.
std::vector<Section> fit_sections(const HeapFits& fits);

}  // namespace grainfield::coupling
