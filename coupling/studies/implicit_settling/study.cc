// The study "implicit-settling": lattice piles of soft disks settle under implicit motion.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "continuum/closed/liffman.h"
#include "coupling/observe/declaration.h"
#include "coupling/result/csv.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/recorded.h"
#include "coupling/studies/implicit_settling/keys.h"
#include "coupling/studies/implicit_settling/simulation.h"
#include "coupling/studies/lattice_pile/keys.h"
#include "coupling/studies/lattice_pile/simulation.h"

namespace grainfield::coupling {
namespace {

dem::ImplicitSettlingSetup setup_of(const Case& value) {
  dem::ImplicitSettlingSetup out = value.get<dem::ImplicitSettlingSetup>();
  out.lattice = value.get<dem::LatticePileSetup>().lattice;
  return out;
}

// Forces of the base disks, m g.
struct BaseForces {
  Eigen::VectorXd x, normal, horizontal, hard_normal, hard_horizontal;
};

BaseForces forces_of(const dem::ImplicitSettlingSetup& setup, const dem::Snapshot& pile) {
  const std::vector<int> rows = dem::lattice_rows(setup.lattice);
  const int base = rows.front();
  BaseForces out;
  out.x = out.normal = out.horizontal = out.hard_normal = out.hard_horizontal =
      Eigen::VectorXd::Zero(base);
  const double weight = setup.weight();
  for (const dem::Contact& c : pile.contacts) {
    if (c.j >= 0 || c.i >= base) continue;
    out.normal[c.i] += c.force.y() / weight;
    out.horizontal[c.i] -= c.force.x() / weight;
  }
  const auto hard = continuum::lattice_base_forces(rows, 1, 1 / std::numbers::sqrt3);
  for (int i = 0; i < base; ++i) {
    out.x[i] = (i + 0.5) / base - 0.5;
    out.hard_normal[i] = hard[static_cast<std::size_t>(i)].normal;
    out.hard_horizontal[i] = hard[static_cast<std::size_t>(i)].horizontal;
  }
  return out;
}

std::string settling_sentence(const StudyResult& result) {
  const auto at = [&](const char* key) { return std::get<double>(result.summary.at(key)); };
  if (at("settling.at_rest") == 1) {
    return fmt::format(
        "The pile is at rest after {:.3g} sqrt(d/g); N is within {:.2g} % and H within {:.2g} % "
        "of the closed form. {:.2g} iterations a solve.",
        at("settling.time"), 100 * at("settling.normal_max_error"),
        100 * at("settling.horizontal_max_error"), at("settling.iterations"));
  }
  return fmt::format(
      "After {:.3g} sqrt(d/g) the pile still moves: its base has spread by {:.3g} diameters and "
      "goes on at {:.3g} sqrt(g d); the mean resultant is {:.2g} of the mean contact force. {:.2g} "
      "iterations a solve.",
      at("settling.time"), at("settling.spread"), at("settling.spread_speed"),
      at("dem.unbalanced_force_ratio"), at("settling.iterations"));
}

std::string base_csv(const BaseForces& f) {
  Csv out;
  out.row("x_over_width", "normal", "normal_closed_form", "horizontal", "horizontal_closed_form");
  for (Eigen::Index i = 0; i < f.x.size(); ++i) {
    out.row(f.x[i], f.normal[i], f.hard_normal[i], f.horizontal[i], f.hard_horizontal[i]);
  }
  return out.text();
}

std::vector<Chart> charts_of(const BaseForces& f, const RecordedColumns& columns) {
  Chart base{"Forces of the base disks",
             "x / B",
             "force / (m g)",
             "N down, H to the right; the closed form counts hard disks on the lattice lines "
             "(Liffman 40-44).",
             {},
             false};
  for (const bool normal : {true, false}) {
    base.frames.push_back(
        {normal ? "N" : "H",
         {{"grains", f.x, normal ? f.normal : f.horizontal, {}, true, false, -1, true},
          {"closed form", f.x, normal ? f.hard_normal : f.hard_horizontal, {}, false}}});
  }
  return {
      base,
      recorded_chart(columns, "Energy", "energy / (m g d)",
                     "Kinetic energy, and what dashpots, friction and wells have taken.",
                     {{"kinetic", "kinetic"},
                      {"lost_normal", "taken by dashpots along the normal"},
                      {"lost_tangential", "taken by friction"},
                      {"lost_well", "taken by wells"},
                      {"lost_scheme", "taken by the scheme"}}),
      recorded_chart(columns, "Newton's method", "iterations a solve", "Means between the records.",
                     {{"iterations", "iterations"}}),
      recorded_chart(columns, "Creep", "spread / d",
                     "By how much the outermost base disks have parted.", {{"spread", "spread"}}),
      recorded_chart(columns, "Distance from hard disks", "largest difference / largest force",
                     "N and H of the base disks against the closed form (Liffman 42, 44).",
                     {{"normal_error", "N"}, {"horizontal_error", "H"}})};
}

// Figures, tables and charts of the first realization: the lattice is perfect, and all are alike.
void add_first(StudyResult& out) {
  const std::string& file = out.realizations.front();
  const Realization first = read_realization(file);
  const RecordedColumns columns =
      recorded_columns(first["pile"], "settling", dem::kSettlingColumns, file);
  const BaseForces f = forces_of(setup_of(out.value), first["pile"]);
  add_values(settling_rows(), {f.normal, f.horizontal, f.hard_normal, f.hard_horizontal, columns},
             out.summary, "settling.");
  const double halved = std::get<double>(out.summary.at("settling.halved"));
  if (halved > 0) {
    out.warnings.push_back(
        fmt::format("{:g} time steps or parts of them were halved: Newton's method did not "
                    "converge, or a disk moved too far (settling.step)",
                    halved));
  }
  out.texts.emplace_back("profiles.csv", base_csv(f));
  out.texts.emplace_back("history.csv", recorded_csv(columns, dem::kSettlingColumns));
  out.sweep_charts = charts_of(f, columns);
}

std::string settling_subtitle(const StudyResult& result) {
  const dem::ImplicitSettlingSetup setup = setup_of(result.value);
  return fmt::format("{} base disks, {:g}°, {} friction, {}", setup.lattice.base_grains,
                     setup.lattice.slope_deg, setup.friction,
                     setup.static_friction > 0 ? "wells" : "no wells");
}

std::vector<Section> settling_pictures(const StudyResult& result, const Realization& first) {
  std::vector<Section> out{packing("Network of forces", first["pile"])};
  for (const Chart& chart : result.sweep_charts) out.emplace_back(chart.picture());
  return out;
}

}  // namespace

Study implicit_settling_study() {
  Study out;
  out.name = "implicit-settling";
  out.meaning = "lattice piles of soft disks settle under implicit motion that keeps energy";
  out.sections = {kLatticeKeys, kSettlingKeys};
  out.figures = {settling_figures};
  out.without = {"compare.models", "output.fields"};
  out.models_optional = true;
  out.make_run = [](const Case& value, std::int64_t number, int /*threads*/) {
    return dem::make_implicit_settling_run(setup_of(value), realization_seed(value, number));
  };
  out.foresee = [](const Case& value, std::int64_t /*draws*/) {
    return dem::foresee_implicit_settling(setup_of(value));
  };
  declare(out, {.more = add_first,
                .told = settling_sentence,
                .subtitle = settling_subtitle,
                .pictures = settling_pictures});
  return out;
}

}  // namespace grainfield::coupling
