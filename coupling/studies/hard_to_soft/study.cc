// The study "hard-to-soft": disks that collide as hard ones and come to rest as soft ones.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include "coupling/report/judgement.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/recorded.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/hard_to_soft/keys.h"
#include "coupling/studies/hard_to_soft/simulation.h"

namespace grainfield::coupling {
namespace {

std::vector<char> soft_ones(const dem::Snapshot& s, const std::string& file) {
  constexpr const char* kSoft[] = {"grains"};
  std::vector<char> out;
  for (const double value : recorded_columns(s, "soft", kSoft, file).at(kSoft[0])) {
    out.push_back(value != 0);
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
  add_rows(out, "Figures", figure_rows(result));
  add_rows(out, "How it was made", origin_rows(result));
  return out;
}

StudyResult analyse_switch(const Case& value, const std::vector<std::string>& files,
                           int /*threads*/) {
  StudyResult out = begin_result(value, files);
  add_figures(out.summary, simulated_figures(files));
  const RecordedColumns columns = recorded_columns(read_realization(files.front())["pile"],
                                                   "switch", dem::kSwitchColumns, files.front());
  out.comparison.judgement.findings = {switch_sentence(out.summary)};
  out.texts.emplace_back("history.csv", recorded_csv(columns, dem::kSwitchColumns));
  const std::vector<Chart> charts{
      recorded_chart(columns, "Soft grains", "share", "Of the first realization.",
                     {{"soft", "soft grains"}}),
      recorded_chart(columns, "Energy", "energy / (m g d)", "Of the first realization.",
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
