// What is shown and left of a sample's RVEs.
#pragma once
#include "coupling/case/study.h"
#include "coupling/report/report.h"
#include "coupling/studies/sample/rve.h"

namespace grainfield::coupling {

void declare_rve_keys(SectionKeys s);

inline constexpr KeySection kRveKeys{"rve", KeyRole::analysis, declare_rve_keys};

/// Keys of the figures of RVEs in summary.json.
std::vector<SummaryKey> rve_summary_keys();
std::vector<SummaryKey> contraction_figures();

/// Error bars against the radius, strains against the imposed one, the hull of an RVE; nothing
/// where no radius fits.
std::vector<Section> rve_sections(const RveTable& table, const std::string& deformation);

/// The hull of an RVE for ParaView: its grains' centres and their displacements to the end of the
/// loading; "" without one.
std::string rve_vtu(const RveTable& table);

}  // namespace grainfield::coupling
