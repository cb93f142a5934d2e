// The study "pair": two bodies that collide, or one led against the other, to see what a contact
// law does with its parameters.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "coupling/report/judgement.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/grain_keys.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/pair/keys.h"
#include "coupling/studies/pair/page.h"
#include "coupling/studies/pair/simulation.h"
#include "coupling/studies/pair/tables.h"

namespace grainfield::coupling {
namespace {

struct Collected {
  FigureSamples figures;
  std::vector<RecordedColumns> profiles, loops;
};

Collected collect(const std::vector<std::string>& files) {
  Collected out;
  for (const std::string& file : files) {
    const Realization one = read_realization(file);
    for (const auto& [key, figure] : one.figures) out.figures[key].push_back(figure);
    out.profiles.push_back(pair_profile(one, file));
    if (RecordedColumns loops = pair_loops(one, file); !loops.empty()) {
      out.loops.push_back(std::move(loops));
    }
  }
  return out;
}

RecordedColumns joined(const std::vector<RecordedColumns>& parts) {
  RecordedColumns out;
  for (const RecordedColumns& part : parts) {
    for (const auto& [name, values] : part) {
      out[name].insert(out[name].end(), values.begin(), values.end());
    }
  }
  return out;
}

void add_closed_forms(const dem::PairSetup& setup, Summary& summary) {
  if (setup.kind != "collision") return;
  for (const dem::PairLaunch& launch : dem::pair_launches(setup)) {
    const PairClosedForm closed = pair_closed_form(setup, launch.speed, launch.angle);
    const auto add = [&](const char* name, double value) {
      if (!std::isnan(value)) summary[launch.name + "closed_form." + name] = value;
    };
    add("restitution_normal", closed.restitution_normal);
    add("restitution_tangential", closed.restitution_tangential);
    add("duration", closed.duration);
    add("max_depth", closed.max_depth);
    add("max_force", closed.max_force);
  }
}

double number(const Summary& summary, const std::string& key) {
  const auto at = summary.find(key);
  return at == summary.end() ? PairClosedForm::kNone : std::get<double>(at->second);
}

std::string own_sentence(const dem::PairSetup& setup, const Summary& s) {
  if (setup.kind == "collision") {
    std::string out = fmt::format("e_n = {:.4f}", number(s, "pair.restitution_normal"));
    if (const double e = number(s, "pair.closed_form.restitution_normal"); !std::isnan(e)) {
      out += fmt::format(" (closed form {:.4f})", e);
    }
    if (const double e = number(s, "pair.restitution_tangential"); !std::isnan(e)) {
      out += fmt::format(", e_t = {:.4f}", e);
    }
    out += fmt::format(". The contact lasts {:.3g} s and is {:.3g} m deep at most.",
                       number(s, "pair.duration"), number(s, "pair.max_depth"));
    if (number(s, "pair.parted") < 1) out += " The bodies did not come apart in that time.";
    return out;
  }
  const double stored = number(s, "pair.stored_most");
  if (setup.path != "random") {
    return fmt::format("The path takes a work of {:.4g} J; the contact stores {:.4g} J at most.",
                       number(s, "pair.work"), stored);
  }
  std::string out = fmt::format(
      "{:g} loops: the work is at most {:.2g} of the largest stored energy, {:.2g} in the mean. "
      "During {:g} of them the outlines cross at more than two places.",
      number(s, "pair.loops"), number(s, "pair.loop_work_over_energy"),
      number(s, "pair.loop_work_over_energy_mean"), number(s, "pair.loops_crossing"));
  if (const double n = number(s, "pair.loops_unsettled"); n > 0) {
    out += fmt::format(" {:g} had not settled with the finest steps.", n);
  }
  return out;
}

std::string sentence_of(const Case& value, const Summary& summary) {
  const std::string own = own_sentence(value.get<dem::PairSetup>(), summary);
  const std::int64_t n = value.ensemble.realizations;
  return n == 1 ? own : fmt::format("Mean of {} realizations: {}", n, own);
}

// The snapshot with the largest force; null without one in the plane.
const dem::Snapshot* hardest(const Realization* realization) {
  const dem::Snapshot* out = nullptr;
  double most = 0;
  if (realization == nullptr) return out;
  for (const auto& [name, snapshot] : realization->snapshots) {
    if (snapshot.dim != 2 || snapshot.contacts.empty()) continue;
    const double force = snapshot.contacts.front().force.norm();
    if (out == nullptr || force > most) {
      out = &snapshot;
      most = force;
    }
  }
  return out;
}

Report page_of(const StudyResult& result, const Realization* first, const PairResults& pair) {
  Report out;
  out.title = title_of(result.value);
  out.subtitle = pair_subtitle(pair.setup);
  add_verdict(out, result.comparison.judgement);
  for (const Chart& chart : pair_charts(pair)) out.sections.emplace_back(chart.picture());
  if (const dem::Snapshot* snapshot = hardest(first)) {
    out.sections.emplace_back(packing("Where they push hardest", *snapshot));
  }
  if (Table impacts = pair_impact_table(pair.impacts); !impacts.rows.empty()) {
    out.sections.emplace_back(std::move(impacts));
  }
  add_rows(out, "Figures", figure_rows(result));
  add_rows(out, "How it was made", origin_rows(result));
  return out;
}

StudyResult analyse_pair(const Case& value, const std::vector<std::string>& files,
                         int /*threads*/) {
  const Collected all = collect(files);
  PairResults pair;
  pair.setup = value.get<dem::PairSetup>();
  pair.profile = all.profiles.front();
  pair.impacts = pair_impacts(value.get<dem::PairSetup>(), all.figures);
  pair.loops = joined(all.loops);

  StudyResult out = begin_result(value, files);
  add_figures(out.summary, all.figures);
  add_closed_forms(value.get<dem::PairSetup>(), out.summary);
  out.comparison.judgement.findings = {sentence_of(value, out.summary)};
  out.texts.emplace_back("profiles.csv", pair_profiles_csv(all.profiles));
  if (!pair.impacts.empty()) out.texts.emplace_back("impacts.csv", pair_impacts_csv(pair.impacts));
  if (!all.loops.empty()) out.texts.emplace_back("loops.csv", pair_loops_csv(all.loops));
  out.sweep_charts = pair_sweep_charts(pair);
  out.page = [pair](const StudyResult& result, const Realization* first) {
    return page_of(result, first, pair);
  };
  return out;
}

}  // namespace

Study pair_study() {
  Study out;
  out.name = "pair";
  out.meaning = "two bodies, or one and a wall, that collide or are led: what a contact law does";
  out.sections = {kMaterialKeys, kMotionKeys, kPairKeys};
  // Bodies that are led have no motion of their own.
  for (const char* key : {"motion.integrator", "motion.time_step", "motion.time_step_fraction"}) {
    out.needs.push_back({key, "pair.kind", {"collision"}});
  }
  out.material = [](Case& c) -> dem::MaterialSetup& { return c.get<dem::PairSetup>().material; };
  out.grain_radius = [](const Case& c) { return c.get<dem::PairSetup>().radius; };
  out.motion = [](Case& c) -> dem::MotionSetup& { return c.get<dem::PairSetup>().motion; };
  out.figures = {pair_figures};
  out.without = {"material.floor_friction", "material.wall_friction", "material.gravity",
                 "motion.energy_balance",   "compare.models",         "output.fields"};
  out.models_optional = true;
  out.make_run = [](const Case& value, std::int64_t number, int threads) {
    return dem::make_pair_run(value.get<dem::PairSetup>(), realization_seed(value, number),
                              threads);
  };
  out.foresee = [](const Case& value, std::int64_t draws) {
    return dem::foresee_pair(value.get<dem::PairSetup>(), realization_seeds(value), draws);
  };
  out.dimension = [](const Case& value) { return value.get<dem::PairSetup>().is_3d() ? 3 : 2; };
  out.dimension_key = "pair.shape";
  out.analyse = analyse_pair;
  return out;
}

}  // namespace grainfield::coupling
