#include "coupling/studies/point_load/fitted.h"

#include <algorithm>
#include <chrono>
#include <memory>

#include "coupling/fit/coverage.h"
#include "coupling/fit/ensemble_fit.h"
#include "coupling/fit/fit_report.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/judge/judge.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/observe/setup.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/studies/point_load/page.h"
#include "coupling/studies/point_load/study.h"

namespace grainfield::coupling {
namespace {

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

// coverage.md of the output folder.
std::string coverage_of_case(const FitSetup& setup, const EnsembleFits& fits, int threads) {
  CoverageOptions options;
  options.sizes.assign(setup.coverage.begin(), setup.coverage.end());
  options.draws = static_cast<int>(setup.coverage_draws);
  options.bootstrap = static_cast<int>(setup.bootstrap);
  options.threads = threads;
  const FitData& data = fits.observed.data;
  return coverage_text(coverage_of(data, fits.models, options), data.realizations());
}

}  // namespace

StudyResult analyse_fitted_load(const Case& value, const std::vector<std::string>& files,
                                int threads) {
  const auto start = std::chrono::steady_clock::now();
  const auto fits = std::make_shared<EnsembleFits>(
      fit_layers(value.get<FitSetup>(), observe_layers(value, files, threads), threads));
  const auto at_width = [&](double width) {
    Case other = value;
    other.get<AverageSetup>().width = 0;
    other.get<AverageSetup>().width_diameters = width;
    other.get<FitSetup>().finite_elements.clear();
    other.get<FitSetup>().bootstrap = 0;
    return fit_layers(other.get<FitSetup>(), observe_layers(other, files, threads), threads)
        .judgement;
  };
  judge_at_widths(value.get<FitSetup>().kernel, at_width, fits->judgement);
  Case with_constants = value;
  with_constants.models = choices(*fits);
  StudyResult out = analyse_point_load(with_constants, files, threads, evaluator_of(fits));
  add_fits(out, *fits);
  if (!value.get<FitSetup>().coverage.empty()) {
    out.texts.emplace_back("coverage.md", coverage_of_case(value.get<FitSetup>(), *fits, threads));
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
    return fitted_layer_page(result, first, *fits);
  };
  out.summary["time.analysis_s"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace grainfield::coupling
