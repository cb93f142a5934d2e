#include "coupling/studies/wedge/page.h"

#include "coupling/report/judgement.h"

namespace grainfield::coupling {

Report wedge_report(const WedgeReport& in) {
  Report report;
  report.title = in.title;
  report.subtitle = in.subtitle;
  add_verdict(report, in.judgement);
  Picture base = curves("Pressure on the base", "x / h (apex at 0)", "-σ_{yy} / (ρ g h)", in.base);
  base.caption =
      "Solid and first: finite elements; Cantelaube's branches have a dip (minus), a plateau "
      "(zero), a peak (plus).";
  report.sections.emplace_back(std::move(base));
  if (!in.mobilized.empty()) {
    Picture zones = maps("Mobilized strength, slip lines and the border of the core", "x / h",
                         "y / h", "mobilized", in.mobilized, false);
    zones.caption =
        "(σ1 - σ3)/(2c cos φ - (σ1 + σ3) sin φ): 1 where the material is at its limit. White: slip "
        "lines of "
        "both families. Red: border between the plastic flanks and the core, the first place seen "
        "from the slope where less than 0.99 is mobilized; dashed: the line from the apex that "
        "halves it, at the measured β̂.";
    report.sections.emplace_back(std::move(zones));
  }
  if (!in.plastic.empty()) {
    Picture strain =
        maps("Plastic shear strain", "x / h", "y / h", "log10, E = 1", in.plastic, false);
    strain.caption =
        "Accumulated difference of the principal plastic strains times E/(ρ g h), decimal "
        "logarithm; blank: none.";
    report.sections.emplace_back(std::move(strain));
  }
  if (!in.cuts.empty())
    report.sections.emplace_back(
        curves("Pressure on horizontal cuts", "x / h", "-σ_{yy} / (ρ g h)", in.cuts));
  report.sections.emplace_back(in.heaps);
  add_rows(report, "Figures", in.figures);
  add_rows(report, "How it was made", in.made);
  return report;
}

}  // namespace grainfield::coupling
