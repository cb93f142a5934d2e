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
#include "coupling/fit/setup.h"
#include "coupling/judge/judge.h"
#include "coupling/models/models.h"
#include "coupling/report/judgement.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/point_load/study.h"
#include "coupling/studies/point_load_verdict/finished_layers.h"
#include "coupling/studies/point_load_verdict/keys.h"
#include "dem/study/setup.h"

namespace grainfield::coupling {
namespace {

std::unique_ptr<dem::Run> make_run(const Case& value, std::int64_t number, int threads) {
  if (!value.get<GrainFiles>().files.empty()) return make_finished_layer_run(value, number);
  return dem::make_point_load_run(value.get<dem::PointLoadSetup>(), realization_seed(value, number),
                                  threads);
}

dem::Outlook foresee(const Case& value, std::int64_t draws) {
  if (value.get<GrainFiles>().files.empty()) {
    return dem::foresee_point_load(value.get<dem::PointLoadSetup>(), realization_seeds(value),
                                   draws);
  }
  try_finished_layers(value);
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
  const double h = fits.observed.height;
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
  const auto known = std::make_shared<std::vector<FitModel>>();
  const auto places = std::make_shared<Eigen::MatrixXd>();
  return [=](const ModelChoice& choice, const RunFacts& facts,
             const std::vector<PointSet>& sets) -> Evaluation {
    const auto fitted = std::find_if(fits->fits.begin(), fits->fits.end(),
                                     [&](const Fit& f) { return f.name == choice.label; });
    if (fitted == fits->fits.end()) return evaluate_model(choice, facts, sets);
    const auto start = std::chrono::steady_clock::now();
    if (known->empty()) {
      Eigen::Index rows = 0;
      for (const PointSet& s : sets) rows += s.smoothing == Smoothing::none ? 0 : s.points.rows();
      places->resize(rows, 2);
      rows = 0;
      for (const PointSet& s : sets) {
        if (s.smoothing == Smoothing::none) continue;
        places->middleRows(rows, s.points.rows()) = s.points / facts.height;
        rows += s.points.rows();
      }
      *known = models_of_layers(fits->asked,
                                std::make_shared<const LayerSight>(*places, *fits->observed.kernel),
                                facts.height);
    }
    const Eigen::MatrixXd all =
        find_fit_model(*known, choice.label).stress(*places, parameters_of(*fitted)) *
        (facts.force / facts.height);
    const auto model = continuum::make_model(choice.name, filled_settings(choice, facts));
    Evaluation out;
    Eigen::Index row = 0;
    for (const PointSet& s : sets) {
      if (s.smoothing == Smoothing::none) {
        out.stresses.push_back(model->stress(s.points));
        continue;
      }
      out.stresses.emplace_back(all.middleRows(row, s.points.rows()));
      row += s.points.rows();
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
                             seen.unit * seen.height, seen.height, seen.data.realizations(),
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
  out.left_unused = unused_layers;
  out.analyse = analyse;
  return out;
}

}  // namespace grainfield::coupling
