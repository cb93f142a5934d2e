#include "coupling/studies/pile/page.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <tuple>

#include "coupling/report/judgement.h"

namespace grainfield::coupling {
namespace {

// In units of h and rho g h.
Series series_of(const Comparison& c, const Profile& p, const std::string& label, bool simulation) {
  Series out{label, p.x / c.depth, p.mean / c.unit(), {}, simulation};
  if (p.error.size() > 0) out.error = p.error / c.unit();
  return out;
}

void add_models(const Comparison& c, std::size_t profile, Frame& frame) {
  for (std::size_t m = 0; m < c.models.size(); ++m) {
    const DrawnLine line = drawn_line(c, m, profile);
    frame.series.push_back({c.models[m].label, line.x / c.depth, line.y / c.unit(), {}, false});
  }
}

std::string scale_note(const Comparison& c) {
  if (c.scale.stress == "N/m") return c.scale.note + ".";
  return fmt::format(
      "In units of h = {:.4g} m and rho g h = {:.4g} N/m (means; every pile is scaled by its own). "
      "The grey band is one standard error over {} realization{} on either side.",
      c.depth, c.unit(), c.realizations, c.realizations == 1 ? "" : "s");
}

void add_base(Report& report, const PileReport& in) {
  const Comparison& c = in.comparison;
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    if (c.profiles[k].key != "base") continue;
    Frame frame;
    frame.series.push_back(series_of(c, c.profiles[k], c.label() + ", base forces", true));
    for (const Profile& p : c.beside) {
      if (p.key.compare(0, 5, "base_") != 0) continue;
      Series s = series_of(c, p, p.name, false);
      s.error.resize(0);
      frame.series.push_back(std::move(s));
    }
    add_models(c, k, frame);
    Picture picture = curves("Vertical pressure on the base", "x / h (apex at 0)",
                             "-σ_{yy}  (ρ g h)", {std::move(frame)});
    picture.caption = fmt::format(
        "{} ({}). {}",
        c.measured() ? "Pressures that were measured on the floor, the models smeared along x "
                       "over the width of the cells"
                     : "Forces of the grains on the floor, smeared along x with the kernel of the "
                       "first averaging",
        in.averaged, scale_note(c));
    report.sections.emplace_back(std::move(picture));
  }
}

void add_cuts(Report& report, const PileReport& in) {
  const Comparison& c = in.comparison;
  for (const auto& [quantity, title, label] :
       {std::tuple{"-sigma_yy", "Vertical pressure on horizontal cuts", "-σ_{yy}"},
        {"-sigma_xx", "Horizontal pressure on horizontal cuts", "-σ_{xx}"},
        {"sigma_xy", "Shear on horizontal cuts", "σ_{xy}"}}) {
    std::vector<Frame> frames;
    for (std::size_t k = 0; k < c.profiles.size(); ++k) {
      if (c.profiles[k].key == "base" || c.profiles[k].quantity != quantity) continue;
      Frame frame;
      frame.title = c.profiles[k].name;
      frame.series.push_back(series_of(c, c.profiles[k], c.label(), true));
      add_models(c, k, frame);
      frames.push_back(std::move(frame));
    }
    if (frames.empty()) continue;
    Picture picture =
        curves(title, c.scale.stress == "N/m" ? "x / h" : "x / h (apex at 0)",
               fmt::format("{}  ({})", label, c.scale.stress == "N/m" ? "N/m" : "ρ g h"), frames);
    picture.caption = "Averaged by " + in.averaged + ". " + scale_note(c);
    report.sections.emplace_back(std::move(picture));
  }
}

void add_maps(Report& report, const PileReport& in) {
  const Comparison& c = in.comparison;
  if (in.map.nx < 2 || in.map.ny < 2) return;
  for (const char* column : {"volume_fraction", "sigma_xx", "sigma_yy", "sigma_xy"}) {
    if (in.map.find(column) == nullptr) return;
  }
  const auto map = [&](const char* title, const char* column, double factor) {
    const Column* found = in.map.find(column);
    Eigen::VectorXd value = factor * found->value;
    // Where there are no grains there is no value.
    const Column* grains = in.map.find("volume_fraction");
    for (Eigen::Index p = 0; p < value.size(); ++p) {
      if (!(grains->value[p] > 0.05)) value[p] = std::nan("");
    }
    return Map{title, in.map.nx, in.map.ny, in.map.points / c.depth, value};
  };
  const std::string averaged = "Averaged by " + in.averaged + ". ";
  Picture density = maps("Volume fraction", "x / h", "y / h", "volume fraction",
                         {map("", "volume_fraction", 1)}, false);
  density.caption =
      averaged +
      "Area of the grains over the area of the kernel that lies inside the heap; white: no "
      "grains. In units of the height h.";
  report.sections.emplace_back(std::move(density));
  const double unit = 1 / c.unit();
  Picture stress = maps(
      "Stress", "x / h", "y / h", "ρ g h",
      {map("vertical pressure -σ_yy", "sigma_yy", -unit),
       map("horizontal pressure -σ_xx", "sigma_xx", -unit), map("shear σ_xy", "sigma_xy", unit)});
  stress.caption = averaged + "One colour scale for all; it ends at the 99 % quantile.";
  report.sections.emplace_back(std::move(stress));
}

// How far the errors themselves are to be trusted: of n values their own is 1/sqrt(2 (n - 1)).
std::string error_note(int realizations) {
  if (realizations < 2) return "One pile: no errors.";
  return fmt::format(
      "Means over {} piles +- standard errors, which are themselves uncertain by {:.0f} %.",
      realizations, 100 / std::sqrt(2.0 * (realizations - 1)));
}

void add_tables(Report& report, const PileReport& in) {
  const Comparison& c = in.comparison;
  if (!c.results.empty()) {
    Table distances{
        fmt::format("Distance of the models from the {}", c.subject()),
        fmt::format("Relative L2: root of the sum of squared differences over that of the {}. "
                    "Misfit and verdict are above.",
                    c.subject()),
        {"model", "relative L2", fmt::format("largest difference ({})", c.scale.stress), "in"},
        {}};
    for (const std::size_t m : ranked(c)) {
      const ModelComparison& r = c.results[m];
      distances.rows.push_back({r.label, fmt::format("{:.1f} %", 100 * r.overall.rel_l2),
                                fmt::format("{:.3g}", r.overall.largest / c.unit()),
                                r.overall.largest_in});
    }
    report.sections.emplace_back(std::move(distances));
  }
  if (!in.changes.rows.empty()) report.sections.emplace_back(in.changes);
  add_rows(report, "Figures", in.figures, error_note(c.realizations));
  add_rows(report, "How it was made", in.made);
}

}  // namespace

Report pile_report(const PileReport& in) {
  Report report;
  report.title = in.title;
  report.subtitle = in.subtitle;
  add_verdict(report, in.comparison.judgement);
  if (in.pile != nullptr) {
    report.sections.emplace_back(grains_by_age("The pile by time of drop", *in.pile));
    report.sections.emplace_back(packing("Network of forces", *in.pile));
  }
  add_base(report, in);
  if (in.beside) report.sections.emplace_back(*in.beside);
  add_cuts(report, in);
  add_maps(report, in);
  if (in.pile != nullptr) {
    for (const auto& [label, state] : in.changed) {
      report.sections.emplace_back(
          displacements("Displacements from the pile to " + label, *in.pile, *state));
    }
    report.sections.emplace_back(contact_angles("Directions of the contacts", *in.pile));
    for (const auto& [label, state] : in.changed) {
      report.sections.emplace_back(contact_angles("Directions of the contacts, " + label, *state));
    }
  }
  add_tables(report, in);
  return report;
}

}  // namespace grainfield::coupling
