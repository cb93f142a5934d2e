// Pictures and words of a pair: its report, and its curves in a sweep's.
#pragma once
#include <string>
#include <vector>

#include "coupling/report/picture.h"
#include "coupling/report/report.h"
#include "coupling/studies/pair/tables.h"

namespace grainfield::coupling {

struct PairResults {
  dem::PairSetup setup;
  RecordedColumns profile;          ///< of the first realization
  std::vector<PairImpact> impacts;  ///< of a collision
  RecordedColumns loops;            ///< of random loops, all realizations together
};

/// Force against depth and time, energies, restitution, loops: what there is of them.
std::vector<Chart> pair_charts(const PairResults& results);
/// Those in which members of a sweep are told apart; forces and depths over their largest.
std::vector<Chart> pair_sweep_charts(const PairResults& results);
/// The impacts as a table; without rows when there is one alone.
Table pair_impact_table(const std::vector<PairImpact>& impacts);

/// Law, bodies and what happens, in a few words.
std::string pair_subtitle(const dem::PairSetup& setup);

}  // namespace grainfield::coupling
