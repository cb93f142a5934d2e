#include "coupling/studies/sample/page.h"

#include <fmt/format.h>

#include "coupling/report/judgement.h"

namespace grainfield::coupling {
namespace {

// A frame for each curve.
Picture frames_of(const SampleReport& in, const std::string& title,
                  const std::vector<SampleCurve>& shown) {
  std::vector<Frame> frames;
  for (const SampleCurve& curve : shown) {
    frames.push_back({curve.title, {sample_series(in, curve, in.label, true)}});
  }
  return curves(title, in.strain_name, "", frames);
}

// All curves in one frame.
Picture together(const SampleReport& in, const std::string& title, const std::string& unit,
                 const std::vector<SampleCurve>& shown) {
  Frame frame;
  for (const SampleCurve& curve : shown) {
    frame.series.push_back(sample_series(in, curve, curve.title, false));
  }
  return curves(title, in.strain_name, unit, {frame});
}

void add_grains(Report& report, const SampleReport& in) {
  const bool plane = in.first->dim == 2, periodic = in.first->cell.is_periodic();
  const std::string images =
      periodic ? " The grains are drawn where they are in the cell (thin outline), which repeats "
                 "itself; a force across its edge ends at the image of the other grain."
               : "";
  const auto add = [&](const std::string& title, const dem::Snapshot& state) {
    Picture picture = plane ? packing(title, state) : slice(title, state);
    picture.caption += images;
    report.sections.emplace_back(std::move(picture));
  };
  add("The first state", *in.first);
  add("The last state", *in.last);
  if (!plane) return;
  report.sections.emplace_back(
      contact_angles("Directions of the contacts, first state", *in.first));
  report.sections.emplace_back(contact_angles("Directions of the contacts, last state", *in.last));
}

}  // namespace

Series sample_series(const SampleReport& in, const SampleCurve& curve, const std::string& label,
                     bool simulation) {
  return {label, in.strain, curve.mean, curve.error, simulation, true};
}

Report sample_report(const SampleReport& in) {
  Report report;
  report.title = in.title;
  report.subtitle = in.subtitle;
  add_verdict(report, in.judgement);
  Picture main = frames_of(in, "Stress ratio and volume", in.main);
  main.caption =
      "Of the whole sample, mean over realizations; the band is one standard error on either side. "
      "Volumetric strain: dilation positive, left out where the test imposes it.";
  report.sections.emplace_back(std::move(main));
  if (in.first != nullptr && in.last != nullptr) add_grains(report, in);
  Picture structure = frames_of(in, "Contacts and fabric", in.structure);
  structure.caption =
      "Contacts of a grain that bears force; deviator of the fabric tensor over its trace; bands "
      "as above.";
  report.sections.emplace_back(std::move(structure));
  Picture stresses = together(in, "Stresses", in.stress_unit, in.stresses);
  stresses.caption = "Compression positive for p; from the contacts alone (Love and Weber).";
  report.sections.emplace_back(std::move(stresses));
  report.sections.insert(report.sections.end(), in.moduli.begin(), in.moduli.end());
  report.sections.insert(report.sections.end(), in.rves.begin(), in.rves.end());
  Picture energies = together(in, "Energies", "J", in.energies);
  energies.caption =
      in.energies.size() > 3
          ? "Since the first state. Work + work of the law = elastic + kinetic + lost."
          : "Since the first state.";
  report.sections.emplace_back(std::move(energies));
  add_rows(report, "Figures", in.figures);
  add_rows(report, "How it was made", in.made);
  return report;
}

}  // namespace grainfield::coupling
