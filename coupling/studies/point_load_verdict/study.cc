#include "coupling/studies/point_load_verdict/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "coupling/fit/coverage.h"
#include "coupling/fit/figures.h"
#include "coupling/fit/fit_report.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/fit/layer_models.h"
#include "coupling/fit/models.h"
#include "coupling/judge/judge.h"
#include "coupling/models/models.h"
#include "coupling/observe/setup.h"
#include "coupling/report/judgement.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/point_load/simulation.h"
#include "coupling/studies/point_load/study.h"
#include "coupling/studies/point_load_verdict/keys.h"
#include "dem/run/run.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

const std::vector<std::string> kStates{"unloaded", "loaded"};
constexpr const char* kStudy = "point-load";
constexpr double kSameForce = 1e-9;  // relative: numbers that went through a file

dem::RunResult finished_layer(const FinishedRun& place, double force) {
  const dem::Snapshot unloaded = dem::read_snapshot(place.file, place.group + "/unloaded");
  const dem::Snapshot loaded = dem::read_snapshot(place.file, place.group + "/loaded");
  const double found = -loaded.applied_force.y();
  if (!(std::fabs(found - force) <= kSameForce * force)) {
    throw std::invalid_argument(
        fmt::format("load.force: found {:g}, the layer {}:{} carries {:g} N", force, place.file,
                    place.group, found));
  }
  dem::RunResult out;
  out.snapshots = {{"unloaded", unloaded}, {"loaded", loaded}};
  auto& f = out.figures;
  f["dem.grains"] = static_cast<double>(std::count_if(
      unloaded.grains.begin(), unloaded.grains.end(), [](const auto& g) { return !g.fixed; }));
  f["load.force"] = found;
  f["base.response_over_load"] =
      (dem::base_force(loaded) - dem::base_force(unloaded)).y() / f["load.force"];
  const dem::ContactChanges c = dem::compare_contacts(unloaded, loaded);
  f["load.contacts_gained"] = c.gained;
  f["load.contacts_lost"] = c.lost;
  f["load.newly_sliding"] = c.newly_sliding;
  f["load.max_displacement_over_radius"] = c.max_displacement_over_radius;
  f["load.no_rearrangement"] = c.gained == 0 && c.lost == 0 ? 1 : 0;
  return out;
}

double force_of(const Case& value) { return value.get<dem::PointLoadSetup>().load.force; }

std::unique_ptr<dem::Run> make_run(const Case& value, std::int64_t number, int threads) {
  if (!value.get<GrainFiles>().files.empty()) {
    return run_of(finished_layer(finished_run(value, number, kStates, kStudy), force_of(value)));
  }
  return dem::make_point_load_run(value.get<dem::PointLoadSetup>(), realization_seed(value, number),
                                  threads);
}

dem::Outlook foresee(const Case& value, std::int64_t draws) {
  if (value.get<GrainFiles>().files.empty()) {
    return dem::foresee_point_load(value.get<dem::PointLoadSetup>(), realization_seeds(value),
                                   draws);
  }
  try_finished_runs(value, kStates, kStudy,
                    [&](const FinishedRun& layer) { finished_layer(layer, force_of(value)); });
  return {};
}

void check(const Case& value) {
  check_point_load(value);
  for (const std::string& name : value.get<VerdictSetup>().finite_elements) {
    try {
      continuum::find_model(name);
    } catch (const continuum::BadParameter& e) {
      throw std::invalid_argument(std::string("verdict.finite_elements: ") + e.what());
    }
  }
}

// The models with their constants, for the tables and maps of every loaded layer.
std::vector<ModelChoice> choices(const EnsembleFits& fits) {
  std::vector<ModelChoice> out;
  const double h = fits.observed.scale.h;
  for (std::size_t k = 0; k < fits.fits.size(); ++k) {
    out.push_back(registry_choice(fits.models[k], parameters_of(fits.fits[k]), h));
  }
  for (const FiniteElementFit& e : fits.elements) {
    std::string of;
    if (auto c = finite_element_choice(e.name, fits.models, fits.fits, h, of)) out.push_back(*c);
  }
  return out;
}

// Fitted models through an operator for all profiles (a layer node by node takes minutes), others
// and the map as the registry gives them.
ModelEvaluator evaluator_of(const std::shared_ptr<const EnsembleFits>& fits) {
  const auto averaged = std::make_shared<std::vector<Eigen::MatrixXd>>();  // of each fit, over h
  return [=](const ModelChoice& choice, const RunFacts& facts,
             const std::vector<PointSet>& sets) -> Evaluation {
    const auto fitted = std::find_if(fits->fits.begin(), fits->fits.end(),
                                     [&](const Fit& f) { return f.name == choice.label; });
    if (fitted == fits->fits.end()) return evaluate_model(choice, facts, sets);
    const auto start = std::chrono::steady_clock::now();
    if (averaged->empty()) {
      std::vector<std::string> names;
      for (const Fit& f : fits->fits) names.push_back(f.name);
      Eigen::MatrixXd places(0, 2);
      for (const PointSet& s : sets) {
        if (s.smoothing == Smoothing::none) continue;
        places.conservativeResize(places.rows() + s.points.rows(), 2);
        places.bottomRows(s.points.rows()) = s.points / facts.height;
      }
      *averaged = models_at(*fits, names, places);
    }
    const Eigen::MatrixXd all =
        averaged->at(static_cast<std::size_t>(fitted - fits->fits.begin())) *
        (facts.force / facts.height);
    const auto model = continuum::make_model(choice.name, filled_settings(choice, facts));
    Evaluation out;
    Eigen::Index row = 0;
    for (const PointSet& s : sets) {
      const bool as_it_is = s.smoothing == Smoothing::none;
      out.stresses.push_back(as_it_is ? model->stress(s.points)
                                      : Eigen::MatrixXd(all.middleRows(row, s.points.rows())));
      row += as_it_is ? 0 : s.points.rows();
    }
    out.figures = model->figures();
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
  };
}

Report page_of(const StudyResult& result, const Realization* first, const EnsembleFits& fits) {
  Report out;
  const Observations& seen = fits.observed;
  out.title = title_of(result.value);
  out.subtitle = fmt::format("F = {:.4g} N on a layer {:.4g} m deep; {} realization{}",
                             seen.scale.unit * seen.scale.h, seen.scale.h, seen.data.realizations(),
                             seen.data.realizations() == 1 ? "" : "s");
  add_verdict(out, fits.judgement);
  for (Section& s : fit_pictures(fits)) out.sections.push_back(std::move(s));
  if (first != nullptr) {
    const dem::Snapshot &unloaded = (*first)["unloaded"], &loaded = (*first)["loaded"];
    out.sections.emplace_back(packing("The loaded packing", loaded));
    out.sections.emplace_back(packing("What the load changes", loaded, &unloaded));
    out.sections.emplace_back(contact_angles("Directions of the contacts", loaded));
  }
  for (Section& s : fit_tables(fits)) out.sections.push_back(std::move(s));
  add_rows(out, "Figures", figure_rows(result));
  add_rows(out, "How it was made", origin_rows(result));
  return out;
}

StudyResult analyse(const Case& value, const std::vector<std::string>& files, int threads) {
  const auto start = std::chrono::steady_clock::now();
  const auto fits = std::make_shared<EnsembleFits>(
      fit_layers(value.get<VerdictSetup>(), observe_layers(value, files, threads), threads));
  const auto at_width = [&](double width) {
    Case other = value;
    other.get<AverageSetup>().width = 0;
    other.get<AverageSetup>().width_diameters = width;
    other.get<VerdictSetup>().finite_elements.clear();
    other.get<VerdictSetup>().bootstrap = 0;
    return fit_layers(other.get<VerdictSetup>(), observe_layers(other, files, threads), threads)
        .judgement;
  };
  judge_at_widths(value.get<VerdictSetup>().kernel, at_width, fits->judgement);
  Case with_constants = value;
  with_constants.models = choices(*fits);
  StudyResult out = analyse_point_load(with_constants, files, threads, evaluator_of(fits));
  add_fits(out, *fits);
  if (!value.get<VerdictSetup>().coverage.empty()) {
    CoverageOptions options;
    options.sizes.assign(value.get<VerdictSetup>().coverage.begin(),
                         value.get<VerdictSetup>().coverage.end());
    options.draws = static_cast<int>(value.get<VerdictSetup>().coverage_draws);
    options.bootstrap = static_cast<int>(value.get<VerdictSetup>().bootstrap);
    options.threads = threads;
    const FitData& data = fits->observed.data;
    out.texts.emplace_back("coverage.md", coverage_text(coverage_of(data, fits->models, options),
                                                        data.realizations()));
  }
  out.overview = {{"best model", "verdict.best_model", ""},
                  {"alone", "verdict.distinguishable", ""},
                  {"equations", "verdict.equations", ""},
                  {"within the errors", "verdict.agrees", ""},
                  {"peaks on the base", "response.peaks", ""},
                  {"peak / (F/h)", "response.peak_over_F_per_h", ""},
                  {"contacts lost", "load.contacts_lost", ""}};
  for (Frame& frame : profile_frames(*fits, "sigma_yy", {"0.5", "base"})) {
    out.sweep_frames.push_back(std::move(frame));
  }
  out.sweep_x = "x / h (load at 0)";
  out.sweep_y = "response of -σ_{yy}  (F/h)";
  out.sweep_sections = [fits](const std::string& name) {
    return fit_map_sections(*fits, fits->judgement.best, name);
  };
  out.sweep_tables = [fits](const std::string& name) { return fit_tables(*fits, name + ": "); };
  out.page = [fits](const StudyResult& result, const Realization* first) {
    return page_of(result, first, *fits);
  };
  out.summary["time.analysis_s"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace

Study point_load_verdict_study() {
  Study out = point_load_study();
  out.name = "point-load-verdict";
  out.meaning =
      "stress models fitted to layers under a point load and ranked: half plane, layer, "
      "orthotropic, OSL";
  out.sections.insert(out.sections.begin(), kGrainFilesKeys);
  out.sections.push_back(kVerdictKeys);
  out.figures.push_back(figures_of_fits);
  out.check = check;
  out.without = {"compare.models", "packing.dim",     "packing.stacking", "packing.sides",
                 "load.weights",   "load.position_y", "load.radius"};
  out.dimension = nullptr;
  out.dimension_key.clear();
  out.models_optional = true;
  out.make_run = make_run;
  out.foresee = foresee;
  out.left_unused = [](const Case& value) { return unused_runs(value, kStates, kStudy); };
  out.analyse = analyse;
  return out;
}

}  // namespace grainfield::coupling
