// Study pile-fields: what a pile is as a continuum, topic by topic (topic.h). It pours piles as
// study pile does, or takes finished ones from grains.files, and changes their gravity.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "coupling/report/judgement.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/pile/figures.h"
#include "coupling/studies/pile/keys.h"
#include "coupling/studies/pile/pile_run.h"
#include "coupling/studies/pile/simulation.h"
#include "coupling/studies/pile_fields/drawing.h"
#include "coupling/studies/pile_fields/keys.h"
#include "coupling/studies/pile_fields/pile_set.h"
#include "coupling/studies/pile_fields/setup.h"
#include "coupling/studies/pile_fields/topic.h"
#include "dem/snapshot/contact_changes.h"

namespace grainfield::coupling {
namespace {

// Strains come from this share of gravity where the case names no other.
constexpr double kLowered = 0.9;

dem::PileSetup setup_of(const Case& value) {
  dem::PileSetup setup = value.get<dem::PileSetup>();
  if (setup.change.gravity.empty()) setup.change.gravity = {kLowered * setup.material.gravity};
  return setup;
}

std::unique_ptr<dem::Run> make_run(const Case& value, std::int64_t number, int threads) {
  return make_pile(value, setup_of(value), number, threads);
}

dem::Outlook foresee(const Case& value, std::int64_t draws) {
  return foresee_pile(value, setup_of(value), draws);
}

// Vertical pressure along rows of the grid: what profiles.csv holds.
Comparison pressures(const PileSet& piles) {
  Ensemble ensemble;
  for (int r = 0; r < piles.count(); ++r) {
    Field one;
    one.points = piles.grid();
    one.add("sigma_yy", "1").value =
        piles.fields(r).rest.find("sigma_yy")->value / piles.frame(r).pressure();
    ensemble.add(one);
  }
  const Field mean = ensemble.mean();
  const Eigen::MatrixXd samples = ensemble.samples("sigma_yy");
  const double h = piles.height(), unit = piles.pressure();
  std::vector<Profile> profiles;
  for (const double height : piles.setup().get<FieldsSetup>().heights) {
    const int row = piles.row_at(height);
    const auto first = static_cast<Eigen::Index>(row) * piles.columns(),
               n = static_cast<Eigen::Index>(piles.columns());
    Profile p;
    const double share = static_cast<double>(row) / (piles.rows() - 1);
    p.name = fmt::format("height {:.3g} h", share);
    p.key = fmt::format("height_{:.3g}", share);
    p.depth = (1 - share) * h;
    p.x = h * piles.grid().col(0).segment(first, n);
    p.mean = -unit * mean.columns.front().value.segment(first, n);
    p.error = unit * mean.columns.front().error.segment(first, n);
    p.samples = -unit * samples.middleRows(first, n);
    p.independent_length = 2 * piles.radius();
    const bool twice = std::any_of(profiles.begin(), profiles.end(),
                                   [&](const Profile& other) { return other.key == p.key; });
    if (!twice && p.mean.array().isFinite().count() >= 3) profiles.push_back(std::move(p));
  }
  if (profiles.empty()) {
    const std::string gaps = piles.gaps_text();
    throw std::invalid_argument(fmt::format(
        "fields.heights: no row of the map has three points with values: {}",
        gaps.empty() ? "allowed: heights inside the heap" : gaps + " (fields.rve_diameters)"));
  }
  return without_models(std::move(profiles), scale_of_heaps(h, unit, scaled_alone(piles.count())),
                        piles.count());
}

const std::vector<RunFigure<PileSet>>& set_rows() {
  using P = const PileSet&;
  static const std::vector<RunFigure<PileSet>> rows{
      {"fields.rve_radius", "m", "radius of the RVE", [](P p) { return p.radius(); }},
      {"fields.points_inside", "-", "points of the map whose RVE is inside the heap",
       [](P p) { return static_cast<std::int64_t>(p.inside().size()); }},
      {"fields.change", "text", "state that strains and constants are taken from",
       [](P p) { return p.change(); }},
  };
  return rows;
}

// Figures of study pile that this one has, too.
const std::set<std::string> kOfPiles{"dem.repose_angle_left_deg",
                                     "dem.repose_angle_right_deg",
                                     "pile.height",
                                     "pile.mean_diameter",
                                     "heap.volume_fraction",
                                     "heap.rho_g_h",
                                     "density.ratio"};

void add_heaps(const PileSet& piles, const std::vector<std::string>& files, Summary& summary) {
  FigureSamples figures;
  for (int r = 0; r < piles.count(); ++r) {
    const PileFrame& f = piles.frame(r);
    const Realization one = read_realization(files[static_cast<std::size_t>(r)]);
    for (const auto& [key, figure] : one.figures) figures[key].push_back(figure);
    const HeapSetup heap;
    FigureSamples own;
    for (const Figure<PileFacts>& row : pile_rows()) {
      if (kOfPiles.contains(row.key)) add_samples<PileFacts>({row}, {one["pile"], f, heap}, own);
    }
    double weight = 0;
    for (const dem::Grain& g : one["pile"].grains) weight += g.fixed ? 0 : g.mass * f.gravity;
    own["base.weight_ratio"] = {dem::base_force(one["pile"]).y() / weight};
    for (const auto& [key, values] : own) {
      if (!one.figures.contains(key)) figures[key].push_back(values.front());
    }
  }
  // A figure that only some of the runs left is none of the ensemble's.
  for (auto at = figures.begin(); at != figures.end();) {
    at = static_cast<int>(at->second.size()) == piles.count() ? std::next(at) : figures.erase(at);
  }
  add_figures(summary, figures);
  if (piles.setup().get<GrainFiles>().files.empty())
    add_values(source_rows(), piles.setup(), summary);
  add_values(set_rows(), piles, summary);
}

std::vector<SummaryKey> pile_fields_figures() {
  std::vector<std::vector<SummaryKey>> parts{declared(set_rows())};
  for (const Topic& topic : topics()) parts.push_back(topic.figures());
  return joined(parts);
}

struct Looked {
  std::string name;
  TopicResult result;
};

Report page_of(const StudyResult& result, const Realization* first, const std::string& change,
               const std::vector<Looked>& looked, const std::string& gaps) {
  Report out;
  out.title = title_of(result.value);
  const std::size_t piles = result.realizations.size();
  out.subtitle = fmt::format("{} pile{} of {} grains, strains from the change to {}", piles,
                             piles == 1 ? "" : "s",
                             first == nullptr ? 0 : (*first)["pile"].grains.size(), change);
  add_verdict(out, result.comparison.judgement);
  if (first != nullptr) {
    out.sections.emplace_back(packing("Network of forces", (*first)["pile"]));
    out.sections.emplace_back(displacements(fmt::format("Displacements to {}", change),
                                            (*first)["pile"], (*first)[change]));
  }
  for (const Looked& one : looked) {
    out.sections.emplace_back(Text{one.name, one.result.sentence, false});
    out.sections.insert(out.sections.end(), one.result.sections.begin(), one.result.sections.end());
  }
  out.sections.emplace_back(Text{
      "Points without a value",
      gaps.empty() ? "Every point whose RVE is inside the heap has enough grains." : gaps, false});
  add_rows(out, "Figures", figure_rows(result, true));
  add_rows(out, "How it was made", origin_rows(result));
  return out;
}

StudyResult analyse(const Case& value, const std::vector<std::string>& files, int threads) {
  StudyResult out = begin_result(value, files);
  const PileSet piles(value, files, threads);
  add_heaps(piles, files, out.summary);
  out.comparison = pressures(piles);
  auto looked = std::make_shared<std::vector<Looked>>();
  std::string sentence;
  for (const Topic& topic : topics()) {
    const auto& chosen = value.get<FieldsSetup>().topics;
    if (std::find(chosen.begin(), chosen.end(), topic.name) == chosen.end()) continue;
    looked->push_back({topic.meaning, topic.evaluate(piles)});
    TopicResult& result = looked->back().result;
    for (const auto& [key, figure] : result.summary) out.summary[key] = figure;
    out.fields.insert(out.fields.end(), result.fields.begin(), result.fields.end());
    out.texts.insert(out.texts.end(), result.texts.begin(), result.texts.end());
    sentence += (sentence.empty() ? "" : " ") + result.sentence;
  }
  out.comparison.judgement.findings = {sentence};
  const std::string gaps = piles.gaps_text();
  out.page = [looked, gaps, change = piles.change()](const StudyResult& result,
                                                     const Realization* first) {
    return page_of(result, first, change, *looked, gaps);
  };
  return out;
}

}  // namespace

const std::vector<Topic>& topics() {
  static const std::vector<Topic> all{rve_size_topic(), strain_measures_topic(), elastic_topic(),
                                      fabric_topic(), forces_topic()};
  return all;
}

Study pile_fields_study() {
  Study out;
  out.name = "pile-fields";
  out.meaning = "piles as a continuum: size of the RVE, strains, elastic constants, fabric, forces";
  describe_piles(out);
  out.sections.push_back(kChangeKeys);
  out.sections.push_back(kFieldsKeys);
  out.averaged = [](const Case& value) -> std::vector<AveragedValues> {
    const auto& f = value.get<FieldsSetup>();
    return {{{{"fields.columns", static_cast<double>(f.columns)},
              {"fields.rows", static_cast<double>(f.rows)}},
             1}};
  };
  out.figures.push_back(pile_fields_figures);
  out.without = {"compare.models"};
  out.make_run = make_run;
  out.foresee = foresee;
  out.analyse = analyse;
  return out;
}

}  // namespace grainfield::coupling
