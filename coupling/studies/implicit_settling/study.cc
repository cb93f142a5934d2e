// The study "implicit-settling": lattice piles of soft disks settle under implicit motion.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>

#include "continuum/closed/liffman.h"
#include "coupling/report/judgement.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/implicit_settling/keys.h"
#include "coupling/studies/lattice_pile/keys.h"
#include "dem/snapshot/number.h"
#include "dem/study/implicit_settling.h"

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
    for (const std::string& file : files) {
      const Realization one = read_realization(file);
      for (const auto& [key, figure] : one.figures) figures_[key].push_back(figure);
    }
    // The lattice is perfect: realizations are alike, and the first one is shown.
    const Realization first = read_realization(files.front());
    for (const char* name : dem::kSettlingColumns) {
      columns_[name] = column(first["pile"], name, files.front());
    }
    measure(first["pile"]);
  }

  StudyResult run() const {
    StudyResult out = begin_result(value_, files_);
    add_figures(out.summary, figures_);
    out.summary["settling.normal_max_error"] = largest_error(normal_, hard_normal_);
    out.summary["settling.horizontal_max_error"] = largest_error(horizontal_, hard_horizontal_);
    for (const char* loss : {"lost_normal", "lost_tangential", "lost_well", "lost_scheme"}) {
      const Eigen::VectorXd& values = columns_.at(loss);
      out.summary[std::string("settling.") + loss] = values[values.size() - 1];
    }
    out.comparison.judgement.findings = {sentence(out.summary)};
    const double halved = std::get<double>(out.summary.at("settling.halved"));
    if (halved > 0) {
      out.warnings.push_back(
          fmt::format("{:g} time steps or parts of them were halved: Newton's method did not "
                      "converge, or a disk moved too far (settling.step)",
                      halved));
    }
    out.texts.emplace_back("profiles.csv", base_csv());
    out.texts.emplace_back("history.csv", history_csv());
    out.overview = {{"at rest", "settling.at_rest", ""},
                    {"N: largest error", "settling.normal_max_error", ""},
                    {"H: largest error", "settling.horizontal_max_error", ""},
                    {"spread / d", "settling.spread", ""},
                    {"its speed / sqrt(g d)", "settling.spread_speed", ""},
                    {"iterations a solve", "settling.iterations", ""},
                    {"halved", "settling.halved", ""},
                    {"balance / (m g d)", "settling.balance_error", ""}};
    out.sweep_charts = charts();
    const std::vector<Chart> all = charts();
    out.page = [all](const StudyResult& result, const Realization* first) {
      return page(result, first, all);
    };
    return out;
  }

 private:
  static Eigen::VectorXd column(const dem::Snapshot& pile, const std::string& name,
                                const std::string& file) {
    const auto at = pile.attributes.find("settling:" + name);
    if (at == pile.attributes.end()) {
      throw std::invalid_argument(fmt::format("{}: has no attribute settling:{}", file, name));
    }
    std::vector<double> values;
    std::istringstream words(at->second);
    for (std::string word; words >> word;) {
      const auto number = dem::parse_number(word);
      if (!number) {
        throw std::invalid_argument(
            fmt::format("{}: settling:{} holds \"{}\"; it must hold numbers", file, name, word));
      }
      values.push_back(*number);
    }
    if (values.empty()) {
      throw std::invalid_argument(fmt::format("{}: settling:{} is empty", file, name));
    }
    return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

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

  static double largest_error(const Eigen::VectorXd& found, const Eigen::VectorXd& of) {
    return (found - of).cwiseAbs().maxCoeff() / of.cwiseAbs().maxCoeff();
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
    std::string out = "x_over_width,normal,normal_closed_form,horizontal,horizontal_closed_form\n";
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      out += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", x_[i], normal_[i], hard_normal_[i],
                         horizontal_[i], hard_horizontal_[i]);
    }
    return out;
  }
  std::string history_csv() const {
    std::string out;
    for (const char* name : dem::kSettlingColumns) {
      out += fmt::format("{}{}", out.empty() ? "" : ",", name);
    }
    out += "\n";
    for (Eigen::Index k = 0; k < columns_.at("time").size(); ++k) {
      std::string row;
      for (const char* name : dem::kSettlingColumns) {
        row += fmt::format("{}{:.9g}", row.empty() ? "" : ",", columns_.at(name)[k]);
      }
      out += row + "\n";
    }
    return out;
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
      Frame frame;
      frame.title = normal ? "N" : "H";
      frame.series.push_back({"grains", x_, normal ? normal_ : horizontal_, {}, true});
      frame.series.back().points = true;
      frame.series.push_back(
          {"closed form", x_, normal ? hard_normal_ : hard_horizontal_, {}, false});
      base.frames.push_back(std::move(frame));
    }
    const Eigen::VectorXd& time = columns_.at("time");
    const auto history = [&](const char* title, const char* y, const char* caption,
                             const std::vector<std::pair<const char*, const char*>>& lines) {
      Chart out{title, "time / sqrt(d/g)", y, caption, {}, false};
      for (const auto& [name, label] : lines) {
        Frame frame;
        frame.title = label;
        frame.series.push_back({"grains", time, columns_.at(name), {}, true});
        out.frames.push_back(std::move(frame));
      }
      return out;
    };
    return {base,
            history("Energy", "energy / (m g d)",
                    "Kinetic energy, and what dashpots, friction and wells have taken.",
                    {{"kinetic", "kinetic"},
                     {"lost_normal", "taken by dashpots along the normal"},
                     {"lost_tangential", "taken by friction"},
                     {"lost_well", "taken by wells"},
                     {"lost_scheme", "taken by the scheme"}}),
            history("Newton's method", "iterations a solve", "Means between the records.",
                    {{"iterations", "iterations"}}),
            history("Creep", "spread / d", "By how much the outermost base disks have parted.",
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
    add_rows(out, "Figures",
             figure_rows(result.summary, {"dem.grains",
                                          "dem.contacts",
                                          "dem.steps",
                                          "dem.time_step",
                                          "dem.unbalanced_force_ratio",
                                          "base.weight_ratio",
                                          "settling.at_rest",
                                          "settling.time",
                                          "settling.normal_max_error",
                                          "settling.horizontal_max_error",
                                          "settling.row_contacts",
                                          "settling.iterations",
                                          "settling.most_iterations",
                                          "settling.halved",
                                          "settling.balance_error",
                                          "settling.lost_normal",
                                          "settling.lost_tangential",
                                          "settling.lost_well",
                                          "settling.lost_scheme",
                                          "settling.spread",
                                          "settling.spread_speed"}));
    add_rows(out, "How it was made", origin_rows(result));
    return out;
  }

  const Case& value_;
  const std::vector<std::string>& files_;
  dem::ImplicitSettlingSetup setup_;
  std::vector<int> rows_;
  std::map<std::string, std::vector<double>> figures_;
  std::map<std::string, Eigen::VectorXd> columns_;
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
