// The study "hard-to-soft": disks that collide as hard ones and come to rest as soft ones.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include "coupling/observe/declaration.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/recorded.h"
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

std::vector<Section> switch_pictures(const StudyResult& result, const Realization& first) {
  std::vector<Section> out;
  const auto& setup = result.value.get<dem::HardToSoftSetup>();
  for (const auto& [name, state] : first.snapshots) {
    const std::string when = fmt::format("t = {:.3g} sqrt(d/g)", state.time / setup.time_unit());
    out.emplace_back(marked_grains("Soft grains, " + when, state,
                                   soft_ones(state, result.realizations.front()),
                                   "Blue: soft grains; pale: hard ones, which fly or collide by "
                                   "impulses."));
  }
  if (const dem::Snapshot* pile = first.find("pile")) {
    out.emplace_back(packing("Network of forces", *pile));
  }
  for (const Chart& chart : result.sweep_charts) out.emplace_back(chart.picture());
  return out;
}

void add_history(StudyResult& out) {
  const std::string& file = out.realizations.front();
  const RecordedColumns columns =
      recorded_columns(read_realization(file)["pile"], "switch", dem::kSwitchColumns, file);
  out.texts.emplace_back("history.csv", recorded_csv(columns, dem::kSwitchColumns));
  out.sweep_charts = {
      recorded_chart(columns, "Soft grains", "share", "Of the first realization.",
                     {{"soft", "soft grains"}}),
      recorded_chart(columns, "Energy", "energy / (m g d)", "Of the first realization.",
                     {{"kinetic", "kinetic"},
                      {"elastic", "elastic, with springs of friction"},
                      {"lost_impulses", "taken by impulses"},
                      {"lost_soft", "taken by soft contacts"}})};
}

}  // namespace

Study hard_to_soft_study() {
  Study out;
  out.name = "hard-to-soft";
  out.meaning =
      "hard disks rain into a box, or are dropped onto a pile one at a time, turn soft grain by "
      "grain and come to rest";
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
  declare(out, {.more = add_history,
                .told = [](const StudyResult& r) { return switch_sentence(r.summary); },
                .subtitle =
                    [](const StudyResult& r) {
                      const auto& s = r.value.get<dem::HardToSoftSetup>();
                      return fmt::format("{} disks, {}, restitution {:g}, softness {:g}", s.disks(),
                                         s.source, s.restitution, s.softness);
                    },
                .pictures = switch_pictures});
  return out;
}

}  // namespace grainfield::coupling
