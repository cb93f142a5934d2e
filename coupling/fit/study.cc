#include "coupling/fit/study.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "coupling/compare/significance.h"
#include "coupling/fields/finished_piles.h"
#include "coupling/fit/heap_report.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/study_result.h"

namespace grainfield::coupling {
namespace {

std::unique_ptr<dem::Run> make_run(const Case& value, std::int64_t number, int threads) {
  dem::PileSetup setup = value.pile;
  setup.change.gravity.clear();
  if (value.grains.files.empty()) {
    return dem::make_pile_run(setup,
                              realization_seed(static_cast<std::uint64_t>(value.ensemble.seed),
                                               static_cast<std::uint64_t>(number)),
                              threads);
  }
  const FinishedPile pile = finished_pile(value, number);
  return dem::make_pile_change_run(setup, pile.file, pile.group, threads);
}

HeapFits fit_all(const Case& value, const std::vector<std::string>& files, int threads) {
  HeapFits out;
  out.heaps = heap_data(value, files, threads);
  const FitData& data = out.heaps.data;
  out.covariance = covariance_of(data, value.fit.covariance);
  const std::vector<FitModel> known = heap_models(out.heaps.facts);
  FitOptions options;
  options.huber = value.fit.huber;
  options.bootstrap = static_cast<int>(value.fit.bootstrap);
  options.threads = threads;
  for (const std::string& name : value.fit.models) {
    out.models.push_back(find_fit_model(known, name));
    out.fits.push_back(fit(data, out.covariance, out.models.back(), options));
  }
  SelectionOptions selection;
  selection.huber = value.fit.huber;
  out.selection = select(data, out.covariance, out.models, out.fits, selection);
  return out;
}

// sigma_yy along the heights, for profiles.*: in N/m and m of the mean heap.
Comparison profiles_of(const HeapFits& fits) {
  const FitData& data = fits.heaps.data;
  double h = 0, unit = 0;
  const double n = static_cast<double>(fits.heaps.frames.size());
  for (const PileFrame& f : fits.heaps.frames) {
    h += f.height / n;
    unit += f.pressure() / n;
  }
  std::vector<Profile> profiles;
  std::vector<ModelProfiles> models;
  for (const FitModel& m : fits.models) models.push_back({m.name, m.label, m.name, {}});
  for (int c = 0; c < static_cast<int>(data.components.size()); ++c) {
    const std::string& name = data.components[static_cast<std::size_t>(c)];
    const double sign = name == "sigma_xy" ? 1 : -1;
    for (int level = 0; level < static_cast<int>(data.levels.size()); ++level) {
      std::vector<int> rows;
      for (int k = 0; k < data.values(); ++k) {
        if (data.component[static_cast<std::size_t>(k)] == c &&
            data.level[static_cast<std::size_t>(k)] == level) {
          rows.push_back(k);
        }
      }
      if (rows.size() < 3) continue;
      const FitData part = rows_of(data, rows);
      Profile p;
      p.name = fmt::format("{} at {} h", name, data.levels[static_cast<std::size_t>(level)]);
      p.key = fmt::format("{}_{}", name, data.levels[static_cast<std::size_t>(level)]);
      p.quantity = (sign < 0 ? "-" : "") + name;
      p.depth = -part.points(0, 1) * h;
      p.x = h * part.points.col(0);
      p.samples = sign * unit * part.samples;
      p.mean = p.samples.rowwise().mean();
      p.error.resize(p.mean.size());
      for (Eigen::Index k = 0; k < p.mean.size(); ++k) {
        const Eigen::VectorXd row = p.samples.row(k);
        p.error[k] = spread_of({row.begin(), row.end()}).standard_error;
      }
      p.independent_length = fits.covariance.correlation_length * h;
      for (std::size_t m = 0; m < models.size(); ++m) {
        Eigen::VectorXd values(static_cast<Eigen::Index>(rows.size()));
        for (std::size_t k = 0; k < rows.size(); ++k) {
          values[static_cast<Eigen::Index>(k)] = sign * unit * fits.fits[m].model[rows[k]];
        }
        models[m].values.push_back(std::move(values));
      }
      profiles.push_back(std::move(p));
    }
  }
  Comparison out =
      compare(std::move(profiles), std::move(models), unit * h, h, data.realizations());
  out.scale = {"h", "rho g h", "apex",
               fmt::format("h = {:.6g} m, rho g h = {:.6g} N/m; every pile scaled by its own; "
                           "realizations: {}",
                           h, unit, data.realizations())};
  return out;
}

Report page_of(const StudyResult& result, const Realization* first, const HeapFits& fits) {
  Report out;
  out.title = result.value.title.empty() ? result.value.name : result.value.title;
  out.subtitle = fmt::format("{} pile{}, slope {:.1f} deg", fits.heaps.frames.size(),
                             fits.heaps.frames.size() == 1 ? "" : "s", fits.heaps.facts.slope_deg);
  out.sections.emplace_back(Text{"", result.comparison.verdict.sentence, true});
  for (Section& section : fit_sections(fits)) out.sections.push_back(std::move(section));
  if (first != nullptr) out.sections.emplace_back(packing("Network of forces", (*first)["pile"]));
  Table made{"How it was made", "", {}, {}};
  for (const auto& [key, value] : origin_rows(result)) made.rows.push_back({key, value});
  out.sections.emplace_back(std::move(made));
  return out;
}

StudyResult analyse(const Case& value, const std::vector<std::string>& files, int threads) {
  const auto start = std::chrono::steady_clock::now();
  StudyResult out;
  out.value = value;
  out.realizations = files;
  add_identity(out.summary, value);
  const auto fits = std::make_shared<HeapFits>(fit_all(value, files, threads));
  out.comparison = profiles_of(*fits);
  add_fits(out.summary, *fits);
  out.comparison.verdict.best_model = fits->selection.ranking.front().name;
  out.comparison.verdict.sentence = fits->selection.sentence;
  out.summary["verdict.sentence"] = fits->selection.sentence;
  out.texts = {{"fits.csv", fits_csv(*fits)},
               {"fits.md", fits_markdown(*fits)},
               {"fits.tex", fits_tex(*fits)}};
  out.overview = {{"best model", "verdict.best_model"},
                  {"beta_hat (deg)", "fit.cantelaube.beta_hat_deg"},
                  {"b1", "fit.cantelaube.b1"},
                  {"eta", "fit.osl.eta"},
                  {"mu", "fit.osl.mu"}};
  out.page = [fits](const StudyResult& result, const Realization* first) {
    return page_of(result, first, *fits);
  };
  out.summary["time.analysis_s"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace

Study pile_fit_study() {
  Study out;
  out.name = "pile-fit";
  out.meaning = "stress models fitted to piles and ranked: Cantelaube, OSL, hydrostatic";
  out.sections = {"grains", "shape", "source", "floor",    "material",
                  "motion", "rest",  "sleep",  "ensemble", "fit"};
  out.without = {"compare.models"};
  out.models_optional = true;
  out.make_run = [](const Case& value, std::uint64_t, int threads) {
    return make_run(value, 0, threads);
  };
  out.make_numbered_run = make_run;
  out.analyse = analyse;
  return out;
}

}  // namespace grainfield::coupling
