#include "coupling/studies/pile/page.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <variant>

#include "coupling/fit/fit_report.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/report/judgement.h"
#include "coupling/run/comparison_page.h"
#include "coupling/studies/pile/simulation.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

std::string scale_note(const Comparison& c) {
  if (c.scale.stress == "N/m") return c.scale.note + ".";
  return fmt::format(
      "In units of h = {:.4g} m and rho g h = {:.4g} N/m (means; every pile is scaled by its own).",
      c.scale.h, c.scale.unit);
}

void add_base(Report& report, const PileReport& in) {
  const Comparison& c = in.comparison;
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    if (c.profiles[k].key != "base") continue;
    Frame frame = profile_frame(c, k);
    frame.title.clear();
    frame.series.front().label += ", base forces";
    for (const Profile& p : c.beside) {
      if (!p.key.starts_with("base_")) continue;
      frame.series.push_back({p.name, p.x / c.scale.h, p.mean / c.scale.unit, {}, false});
    }
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
      frames.push_back(profile_frame(c, k));
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
    return Map{title, in.map.nx, in.map.ny, in.map.points / c.scale.h, value};
  };
  const std::string averaged = "Averaged by " + in.averaged + ". ";
  Picture density = maps("Volume fraction", "x / h", "y / h", "volume fraction",
                         {map("", "volume_fraction", 1)}, false);
  density.caption =
      averaged +
      "Area of the grains over the area of the kernel that lies inside the heap; white: no "
      "grains. In units of the height h.";
  report.sections.emplace_back(std::move(density));
  const double unit = 1 / c.scale.unit;
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
      "Means over {} piles ± standard errors, which are themselves uncertain by {:.0f} %.",
      realizations, 100 / std::sqrt(2.0 * (realizations - 1)));
}

void add_tables(Report& report, const PileReport& in) {
  const Comparison& c = in.comparison;
  if (!c.results.empty()) report.sections.emplace_back(distances_table(c, c.scale.stress));
  report.sections.insert(report.sections.end(), in.fit_tables.begin(), in.fit_tables.end());
  if (!in.changes.rows.empty()) report.sections.emplace_back(in.changes);
  add_rows(report, "Figures", in.figures, error_note(c.realizations));
  add_rows(report, "How it was made", in.made);
}

// A row for every changed gravity, from the least one.
Table changes_of(const Summary& summary) {
  Table table{"Changed gravity",
              "Means over the piles with standard errors; against each pile under its own gravity.",
              {"gravity", "contacts per grain, ratio", "contacts opened", "closed",
               "brought to sliding", "largest displacement / r", "dip's change (rho g h)"},
              {}};
  const std::string first = "change.gravity_", last = ".coordination_ratio";
  std::map<double, std::string> changes;
  for (const auto& [key, unused] : summary) {
    if (!key.starts_with(first) || !key.ends_with(last)) continue;
    const std::string name = key.substr(0, key.size() - last.size());
    if (const auto gravity = parse_number(name.substr(first.size()))) {
      changes[*gravity] = name;
    }
  }
  for (const auto& [gravity, name] : changes) {
    std::vector<std::string> row{fmt::format("{:g} m/s2", gravity)};
    for (const char* what :
         {".coordination_ratio", ".contacts_lost", ".contacts_gained", ".newly_sliding",
          ".max_displacement_over_radius", ".dip_difference_change"}) {
      row.push_back(shown_with_error(summary, name + what));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

// Figures without a value say why, where it is the flanks.
void add_reasons(ReportRows& rows, const std::string& flat) {
  for (auto& [name, value] : rows) {
    const bool slope = name.find("repose") != std::string::npos;
    const bool window = name.find("(pile.volume_fraction_") != std::string::npos ||
                        name.find("(density.") != std::string::npos;
    if (!value.starts_with("-") || (value.size() > 1 && value[1] != ' ')) continue;
    if (slope && !flat.empty()) value = "- (" + flat + ")";
    if (window) value = "- (a pile is too small or too flat for these windows)";
  }
}

}  // namespace

Report pile_report(const PileReport& in) {
  Report report;
  report.title = in.title;
  report.subtitle = in.subtitle;
  add_verdict(report, in.comparison.judgement);
  report.sections.insert(report.sections.end(), in.fit_pictures.begin(), in.fit_pictures.end());
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

Report pile_page(const StudyResult& result, const Realization* first, const PilePageFacts& facts) {
  PileReport in;
  if (facts.beside) in.beside = facts.beside->picture();
  in.title = title_of(result.value);
  // What stands, which is not what the case says where piles are taken from files.
  double grains = result.value.get<dem::PileSetup>().source.grains;
  if (const auto standing = result.summary.find("dem.grains"); standing != result.summary.end()) {
    if (const auto* mean = std::get_if<double>(&standing->second)) grains = *mean;
  }
  in.subtitle = fmt::format("{} pile{}, {:.0f} grains each", result.realizations.size(),
                            result.realizations.size() == 1 ? "" : "s", grains);
  if (first != nullptr) {
    in.pile = first->find("pile");
    for (const auto& [name, state] : first->snapshots) {
      if (!dem::is_change(name)) continue;
      in.changed.emplace_back(fmt::format("g = {:g} m/s2", state.gravity.norm()), &state);
    }
  }
  in.comparison = facts.fitted != nullptr ? facts.fitted->piles : result.comparison;
  in.comparison.judgement = result.comparison.judgement;
  if (facts.fitted != nullptr) {
    in.fit_pictures = fit_pictures(*facts.fitted->fits);
    in.fit_tables = fit_tables(*facts.fitted->fits);
  }
  in.map = result.map;
  in.averaged = facts.averaged;
  in.figures = figure_rows(result);
  add_reasons(in.figures, facts.flat);
  in.changes = changes_of(result.summary);
  in.made = origin_rows(result);
  return pile_report(in);
}

}  // namespace grainfield::coupling
