// The study "implicit-settling": lattice piles of soft disks settle under implicit motion.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "continuum/closed/liffman.h"
#include "coupling/report/judgement.h"
#include "coupling/result/csv.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/recorded.h"
#include "coupling/run/study_result.h"
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

class SettlingAnalysis {
 public:
  SettlingAnalysis(const Case& value, const std::vector<std::string>& files)
      : value_(value), files_(files), setup_(setup_of(value)) {
    rows_ = dem::lattice_rows(setup_.lattice);
    // The lattice is perfect: realizations are alike, and the first one is shown.
    const Realization first = read_realization(files.front());
    columns_ = recorded_columns(first["pile"], "settling", dem::kSettlingColumns, files.front());
    measure(first["pile"]);
  }

  StudyResult run() const {
    StudyResult out = begin_result(value_, files_);
    add_figures(out.summary, simulated_figures(files_));
    add_values(settling_rows(), {normal_, horizontal_, hard_normal_, hard_horizontal_, columns_},
               out.summary, "settling.");
    out.comparison.judgement.findings = {sentence(out.summary)};
    const double halved = std::get<double>(out.summary.at("settling.halved"));
    if (halved > 0) {
      out.warnings.push_back(
          fmt::format("{:g} time steps or parts of them were halved: Newton's method did not "
                      "converge, or a disk moved too far (settling.step)",
                      halved));
    }
    out.texts.emplace_back("profiles.csv", base_csv());
    out.texts.emplace_back("history.csv", recorded_csv(columns_, dem::kSettlingColumns));
    out.sweep_charts = charts();
    const std::vector<Chart> all = charts();
    out.page = [all](const StudyResult& result, const Realization* first) {
      return page(result, first, all);
    };
    return out;
  }

 private:
  void measure(const dem::Snapshot& pile) {
    const int base = rows_.front();
    x_ = normal_ = horizontal_ = hard_normal_ = hard_horizontal_ = Eigen::VectorXd::Zero(base);
    const double weight = setup_.weight();
    for (const dem::Contact& c : pile.contacts) {
      if (c.j >= 0 || c.i >= base) continue;
      normal_[c.i] += c.force.y() / weight;
      horizontal_[c.i] -= c.force.x() / weight;
    }
    const auto hard = continuum::lattice_base_forces(rows_, 1, 1 / std::numbers::sqrt3);
    for (int i = 0; i < base; ++i) {
      x_[i] = (i + 0.5) / base - 0.5;
      hard_normal_[i] = hard[static_cast<std::size_t>(i)].normal;
      hard_horizontal_[i] = hard[static_cast<std::size_t>(i)].horizontal;
    }
  }

  std::string sentence(const Summary& summary) const {
    const auto at = [&](const char* key) { return std::get<double>(summary.at(key)); };
    if (at("settling.at_rest") == 1) {
      return fmt::format(
          "The pile is at rest after {:.3g} sqrt(d/g); N is within {:.2g} % and H within {:.2g} % "
          "of the closed form. {:.2g} iterations a solve.",
          at("settling.time"), 100 * at("settling.normal_max_error"),
          100 * at("settling.horizontal_max_error"), at("settling.iterations"));
    }
    return fmt::format(
        "After {:.3g} sqrt(d/g) the pile still moves: its base has spread by {:.3g} diameters and "
        "goes on at {:.3g} sqrt(g d); the mean resultant is {:.2g} of the mean contact force. "
        "{:.2g} "
        "iterations a solve.",
        at("settling.time"), at("settling.spread"), at("settling.spread_speed"),
        at("dem.unbalanced_force_ratio"), at("settling.iterations"));
  }

  std::string base_csv() const {
    Csv out;
    out.row("x_over_width", "normal", "normal_closed_form", "horizontal", "horizontal_closed_form");
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      out.row(x_[i], normal_[i], hard_normal_[i], horizontal_[i], hard_horizontal_[i]);
    }
    return out.text();
  }

  std::vector<Chart> charts() const {
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
           {{"grains", x_, normal ? normal_ : horizontal_, {}, true, false, -1, true},
            {"closed form", x_, normal ? hard_normal_ : hard_horizontal_, {}, false}}});
    }
    return {base,
            recorded_chart(columns_, "Energy", "energy / (m g d)",
                           "Kinetic energy, and what dashpots, friction and wells have taken.",
                           {{"kinetic", "kinetic"},
                            {"lost_normal", "taken by dashpots along the normal"},
                            {"lost_tangential", "taken by friction"},
                            {"lost_well", "taken by wells"},
                            {"lost_scheme", "taken by the scheme"}}),
            recorded_chart(columns_, "Newton's method", "iterations a solve",
                           "Means between the records.", {{"iterations", "iterations"}}),
            recorded_chart(columns_, "Creep", "spread / d",
                           "By how much the outermost base disks have parted.",
                           {{"spread", "spread"}})};
  }

  static Report page(const StudyResult& result, const Realization* first,
                     const std::vector<Chart>& charts) {
    Report out;
    const dem::ImplicitSettlingSetup setup = setup_of(result.value);
    out.title = title_of(result.value);
    out.subtitle = fmt::format("{} base disks, {:g}°, {} friction, {}", setup.lattice.base_grains,
                               setup.lattice.slope_deg, setup.friction,
                               setup.static_friction > 0 ? "wells" : "no wells");
    add_verdict(out, result.comparison.judgement);
    const dem::Snapshot* pile = first != nullptr ? first->find("pile") : nullptr;
    if (pile != nullptr) out.sections.emplace_back(packing("Network of forces", *pile));
    for (const Chart& chart : charts) out.sections.emplace_back(chart.picture());
    add_rows(out, "Figures", figure_rows(result));
    add_rows(out, "How it was made", origin_rows(result));
    return out;
  }

  const Case& value_;
  const std::vector<std::string>& files_;
  dem::ImplicitSettlingSetup setup_;
  std::vector<int> rows_;
  RecordedColumns columns_;
  Eigen::VectorXd x_, normal_, horizontal_, hard_normal_, hard_horizontal_;  // of base disks, m g
};

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
  out.analyse = [](const Case& value, const std::vector<std::string>& files, int /*threads*/) {
    return SettlingAnalysis(value, files).run();
  };
  return out;
}

}  // namespace grainfield::coupling
