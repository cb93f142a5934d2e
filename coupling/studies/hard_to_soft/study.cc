// The study "hard-to-soft": disks that collide as hard ones and come to rest as soft ones.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <map>
#include <sstream>

#include "coupling/report/judgement.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/hard_to_soft/keys.h"
#include "dem/snapshot/number.h"
#include "dem/study/hard_to_soft.h"

namespace grainfield::coupling {
namespace {

// Numbers between spaces; throws std::invalid_argument naming the file.
std::vector<double> switch_numbers(const dem::Snapshot& s, const std::string& name,
                                   const std::string& file) {
  const auto at = s.attributes.find("switch:" + name);
  std::vector<double> out;
  if (at != s.attributes.end()) {
    std::istringstream words(at->second);
    for (std::string word; words >> word;) {
      const auto number = dem::parse_number(word);
      if (!number) {
        throw std::invalid_argument(
            fmt::format("{}: switch:{} holds \"{}\"; it must hold numbers", file, name, word));
      }
      out.push_back(*number);
    }
  }
  if (out.empty()) {
    throw std::invalid_argument(fmt::format("{}: has no values of switch:{}", file, name));
  }
  return out;
}

std::vector<char> soft_ones(const dem::Snapshot& s, const std::string& file) {
  std::vector<char> out;
  for (const double value : switch_numbers(s, "soft_grains", file)) out.push_back(value != 0);
  return out;
}

Chart switch_chart(const std::map<std::string, Eigen::VectorXd>& columns, const char* title,
                   const char* y, const char* caption,
                   const std::vector<std::pair<const char*, const char*>>& lines) {
  Chart out{title, "time / sqrt(d/g)", y, caption, {}, false};
  for (const auto& [name, label] : lines) {
    Frame frame;
    frame.title = label;
    frame.series.push_back({"grains", columns.at("time"), columns.at(name), {}, true});
    out.frames.push_back(std::move(frame));
  }
  return out;
}

std::string switch_sentence(const Summary& summary) {
  const auto at = [&](const char* key) { return std::get<double>(summary.at(key)); };
  return fmt::format(
      "{} after {:.3g} sqrt(d/g): {:.3g} % of the grains are soft. {:.3g} impulses took {:.3g} m g "
      "d, soft contacts {:.3g}; switches brought {:.2g}, and the balance closes to {:.1g}.",
      at("switch.at_rest") == 1 ? "At rest" : "Still moving", at("switch.time"),
      100 * at("switch.soft_share"), at("switch.collisions"), at("switch.lost_impulses"),
      at("switch.lost_soft"), at("switch.switched"), at("switch.balance_error"));
}

Report switch_page(const StudyResult& result, const Realization* first,
                   const std::vector<Chart>& charts) {
  Report out;
  const auto& setup = result.value.get<dem::HardToSoftSetup>();
  out.title = title_of(result.value);
  out.subtitle = fmt::format("{} disks, restitution {:g}, softness {:g}",
                             setup.columns * setup.rows, setup.restitution, setup.softness);
  add_verdict(out, result.comparison.judgement);
  if (first != nullptr) {
    for (const auto& [name, state] : first->snapshots) {
      const std::string when = fmt::format("t = {:.3g} sqrt(d/g)", state.time / setup.time_unit());
      out.sections.emplace_back(marked_grains("Soft grains, " + when, state,
                                              soft_ones(state, result.realizations.front()),
                                              "Blue: soft grains; pale: hard ones, which fly or "
                                              "collide by impulses."));
    }
    if (const dem::Snapshot* pile = first->find("pile")) {
      out.sections.emplace_back(packing("Network of forces", *pile));
    }
  }
  for (const Chart& chart : charts) out.sections.emplace_back(chart.picture());
  add_rows(out, "Figures",
           figure_rows(
               result.summary,
               {"dem.grains", "dem.contacts", "dem.steps", "dem.time_step",
                "dem.unbalanced_force_ratio", "base.weight_ratio", "switch.at_rest", "switch.time",
                "switch.soft_share", "switch.collisions", "switch.to_soft", "switch.to_hard",
                "switch.pressed", "switch.lost_impulses", "switch.lost_soft", "switch.switched",
                "switch.balance_error", "switch.iterations", "switch.halved"}));
  add_rows(out, "How it was made", origin_rows(result));
  return out;
}

StudyResult analyse_switch(const Case& value, const std::vector<std::string>& files,
                           int /*threads*/) {
  StudyResult out = begin_result(value, files);
  std::map<std::string, std::vector<double>> figures;
  std::map<std::string, Eigen::VectorXd> columns;
  for (const std::string& file : files) {
    const Realization one = read_realization(file);
    for (const auto& [key, figure] : one.figures) figures[key].push_back(figure);
    if (!columns.empty()) continue;
    for (const char* name : dem::kSwitchColumns) {
      std::vector<double> values = switch_numbers(one["pile"], name, file);
      columns[name] =
          Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    }
  }
  add_figures(out.summary, figures);
  out.comparison.judgement.findings = {switch_sentence(out.summary)};
  std::string csv;
  for (const char* name : dem::kSwitchColumns)
    csv += fmt::format("{}{}", csv.empty() ? "" : ",", name);
  csv += "\n";
  for (Eigen::Index k = 0; k < columns.at("time").size(); ++k) {
    std::string row;
    for (const char* name : dem::kSwitchColumns) {
      row += fmt::format("{}{:.9g}", row.empty() ? "" : ",", columns.at(name)[k]);
    }
    csv += row + "\n";
  }
  out.texts.emplace_back("history.csv", csv);
  out.overview = {{"at rest", "switch.at_rest", ""},
                  {"soft", "switch.soft_share", ""},
                  {"impulses", "switch.collisions", ""},
                  {"lost by them / (m g d)", "switch.lost_impulses", ""},
                  {"by soft contacts", "switch.lost_soft", ""},
                  {"balance / (m g d)", "switch.balance_error", ""}};
  const std::vector<Chart> charts{
      switch_chart(columns, "Soft grains", "share", "Of the first realization.",
                   {{"soft", "soft grains"}}),
      switch_chart(columns, "Energy", "energy / (m g d)", "Of the first realization.",
                   {{"kinetic", "kinetic"},
                    {"elastic", "elastic, with springs of friction"},
                    {"lost_impulses", "taken by impulses"},
                    {"lost_soft", "taken by soft contacts"}})};
  out.sweep_charts = charts;
  out.page = [charts](const StudyResult& result, const Realization* first) {
    return switch_page(result, first, charts);
  };
  return out;
}

}  // namespace

Study hard_to_soft_study() {
  Study out;
  out.name = "hard-to-soft";
  out.meaning = "hard disks rain into a box, turn soft grain by grain and come to rest";
  out.sections = {kSwitchKeys};
  out.figures = {switch_figures};
  out.without = {"compare.models", "output.fields"};
  out.models_optional = true;
  out.make_run = [](const Case& value, std::int64_t number, int /*threads*/) {
    return dem::make_hard_to_soft_run(value.get<dem::HardToSoftSetup>(),
                                      realization_seed(value, number));
  };
  out.foresee = [](const Case& value, std::int64_t /*draws*/) {
    return dem::foresee_hard_to_soft(value.get<dem::HardToSoftSetup>());
  };
  out.analyse = analyse_switch;
  return out;
}

}  // namespace grainfield::coupling
