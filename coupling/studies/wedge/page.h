// The page of the study wedge: plastic zones with slip lines and the core's border, base pressures,
// and the table of the heaps.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "coupling/judge/judgement.h"
#include "coupling/report/report.h"

namespace grainfield::coupling {

struct WedgeReport {
  std::string title, subtitle;
  Judgement judgement;
  std::vector<Frame> base, cuts;        ///< pressure over rho g h against x/h
  std::vector<Map> mobilized, plastic;  ///< with slip lines and borders as their lines
  Table heaps;                          ///< one row each
  ReportRows figures, made;
};

Report wedge_report(const WedgeReport& input);

}  // namespace grainfield::coupling
