// Elastic moduli of a sample from small strains at rest
// (coupling/studies/sample/simulation/probe.h).
#pragma once
#include <string>
#include <vector>

#include "coupling/case/study.h"
#include "coupling/elastic_constants/space_symmetry.h"
#include "coupling/report/report.h"
#include "coupling/result/tables.h"

namespace grainfield::coupling {

/// One state of all realizations; nan where a realization could not be probed.
struct ProbedState {
  std::string state;                 ///< "prepared" | "first"
  std::vector<std::string> lacking;  ///< by realization, why it could not be; "": it was
  std::vector<SpaceModuli> moduli;   ///< by realization
  std::vector<double> gained, lost;  ///< largest share of the contacts in any probe, likewise
  std::vector<double> sliding;
  std::vector<double> nonlinear;  ///< ProbedPacking::nonlinear, by realization
  /// Largest |C_ab - C_ba| of the axes over the mean of C_aa: 0 where the stress has a potential.
  std::vector<double> asymmetry;
  SpaceSymmetry symmetry;  ///< of all realizations together
};

/// Those that were probed, in the order of the path. `files`: of the realizations. Throws
/// std::invalid_argument when an attribute is broken.
std::vector<ProbedState> probed_moduli(const std::vector<std::string>& files);

/// By summary key moduli.STATE.*, a number for each realization.
FigureSamples moduli_figures(const std::vector<ProbedState>& states);
/// Adds chances and word of the symmetry of all realizations together.
void add_symmetry(const std::vector<ProbedState>& states, Summary& summary);

/// What could not be probed and why; a table with a column for each state, where any was.
std::vector<Section> moduli_sections(const std::vector<ProbedState>& states,
                                     const Summary& summary);

std::vector<SummaryKey> moduli_summary_keys();

}  // namespace grainfield::coupling
