#include "coupling/studies/lattice_pile/page.h"

#include <fmt/format.h>

#include "coupling/report/force_lines.h"
#include "coupling/report/judgement.h"

namespace grainfield::coupling {

std::vector<Frame> base_frames(const Comparison& c, double weight, double width, double spacing,
                               const std::string& title) {
  std::vector<Frame> frames;
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    const Profile& p = c.profiles[k];
    Frame frame;
    frame.title = (title.empty() ? "" : title + ": ") + (p.key == "base" ? "N" : "H");
    const double unit = weight / spacing;
    frame.series.push_back({"grains", p.x / width, p.mean / unit, {}, true});
    for (const ModelProfiles& m : c.models) {
      frame.series.push_back({m.label == "liffman" ? "line model" : m.label,
                              p.x / width,
                              m.values[k] / unit,
                              {},
                              false});
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

Report lattice_pile_report(const LatticePileReport& in) {
  const Comparison& c = in.comparison;
  Report report;
  report.title = in.title;
  report.subtitle = in.subtitle;
  add_verdict(report, c.judgement);
  if (in.pile != nullptr) {
    report.sections.emplace_back(packing("Network of forces", *in.pile));
    report.sections.emplace_back(
        force_lines("Lines of maximum force", *in.pile, Extreme::strongest));
    report.sections.emplace_back(force_lines("Lines of minimum force", *in.pile, Extreme::weakest));
  }
  Picture base = curves("Forces of the base disks on the ground", "x / B", "force / (m g)",
                        base_frames(c, in.weight, in.width, in.spacing, ""));
  base.caption = fmt::format(
      "N down, H to the right, of each disk of the lowest row, in units of a disk's weight m g = "
      "{:.4g} N; B = {:.4g} m. The closed form counts the hard disks on the two lattice lines that "
      "meet at a base disk (Liffman 40-44); the line model is its continuum (52-59).",
      in.weight, in.width);
  report.sections.emplace_back(std::move(base));
  if (in.beside) report.sections.emplace_back(*in.beside);
  Table distances{"Distance from the grains",
                  "Relative L2: root of the sum of squared differences over that of the grains.",
                  {"model", "N: relative L2", "H: relative L2", "largest difference (m g)", "of"},
                  {}};
  for (const ModelComparison& r : c.results) {
    distances.rows.push_back({r.label, fmt::format("{:.3g} %", 100 * r.per_profile[0].rel_l2),
                              fmt::format("{:.3g} %", 100 * r.per_profile[1].rel_l2),
                              fmt::format("{:.3g}", r.overall.largest * in.spacing / in.weight),
                              r.overall.largest_in});
  }
  report.sections.emplace_back(std::move(distances));
  add_rows(report, "Figures", in.figures);
  add_rows(report, "How it was made", in.made);
  return report;
}

}  // namespace grainfield::coupling
