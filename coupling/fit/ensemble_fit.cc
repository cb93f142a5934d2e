#include "coupling/fit/ensemble_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/compare/smooth.h"
#include "coupling/fit/derived.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/fit/heap_models.h"
#include "coupling/fit/intervals.h"
#include "coupling/fit/layer_models.h"
#include "coupling/fit/open_models.h"
#include "coupling/judge/words.h"
#include "coupling/observe/heap_rows.h"
#include "coupling/statistics/spread.h"

namespace grainfield::coupling {

namespace {

std::vector<RegistryEntry> heap_entries_of(const std::vector<std::string>& texts,
                                           const HeapFacts& facts, double height) {
  return chosen_entries(
      texts, heap_entries(facts),
      [&](const std::string& registry) { return facts_of(facts, registry); }, height);
}

FitModel seen_entry(const RegistryEntry& entry, const HeapFacts& facts,
                    const std::shared_ptr<const HeapSight>& sight) {
  return seen_through(model_of_entry(entry, facts_of(facts, entry.registry)), sight);
}

// A laboratory's cells are flat, each as long as the kernel is wide.
std::shared_ptr<const HeapSight> heap_sight(const Eigen::MatrixXd& places,
                                            const Observations& heaps) {
  return std::make_shared<const HeapSight>(HeapSight{
      Places(places),
      heaps.measured
          ? ObservationOperator({{places, Smoothing::marginal, heaps.kernel.get(), true}}, 0)
          : ObservationOperator::of_heap(places, *heaps.kernel)});
}

// The heaps' facts with the slopes that these alone have.
HeapFacts facts_of_part(const FitSetup& setup, const HeapFacts& all,
                        const std::vector<PileFrame>& part) {
  HeapFacts facts = all;
  const HeapSlopes slopes = slopes_of(setup, part);
  facts.slope_deg = slopes.mean_deg;
  if (all.left_deg > 0) {
    facts.left_deg = slopes.left_deg;
    facts.right_deg = slopes.right_deg;
  }
  if (facts.friction_deg > 0) {
    facts.friction_deg = std::max({facts.friction_deg, facts.left(), facts.right()});
  }
  return facts;
}

}  // namespace

std::vector<FitModel> models_of(const FitSetup& setup, const Observations& heaps) {
  const auto sight = heap_sight(places_of(heaps.data), heaps);
  std::vector<FitModel> out;
  for (const RegistryEntry& entry : heap_entries_of(setup.models, heaps.facts, heaps.scale.h)) {
    out.push_back(seen_entry(entry, heaps.facts, sight));
  }
  if (heaps.frames.size() < 2 || setup.left_deg > 0 || setup.right_deg > 0) return out;
  const auto of_part = [setup, sight, frames = heaps.frames, all = heaps.facts, h = heaps.scale.h](
                           std::size_t model, const std::vector<int>& chosen) {
    std::vector<PileFrame> part;
    for (const int k : chosen) part.push_back(frames[static_cast<std::size_t>(k)]);
    const HeapFacts facts = facts_of_part(setup, all, part);
    return seen_entry(heap_entries_of(setup.models, facts, h)[model], facts, sight);
  };
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].measured_on = [of_part, k](const std::vector<int>& chosen) {
      return of_part(k, chosen);
    };
  }
  return out;
}

std::vector<FitModel> models_of_layers(const std::vector<std::string>& texts,
                                       const std::shared_ptr<const LayerSight>& sight,
                                       double height) {
  const auto facts = [](const std::string&) { return facts_of_layer(); };
  std::vector<FitModel> out;
  for (const RegistryEntry& entry : chosen_entries(texts, layer_entries(), facts, height)) {
    out.push_back(model_of_entry(entry, facts_of_layer(), sight));
  }
  return out;
}

namespace {

// What constants that are no stress field are called; empty: they are one within the errors.
std::string imbalance(const Fit& fit, double slope_deg, int realizations) {
  std::vector<std::string> off;
  const bool known_errors =
      std::any_of(fit.parameters.begin(), fit.parameters.end(),
                  [](const FittedParameter& p) { return std::isfinite(p.error); });
  for (const FittedParameter& d : derived_figures(fit, slope_deg)) {
    if (d.parameter.name.compare(0, 13, "flank_balance") != 0) continue;
    // It hangs on a constant that the data do not determine.
    if (known_errors && !std::isfinite(d.error)) continue;
    const double reach = std::isfinite(d.error) ? student(realizations, 0.95) * d.error : 0.01;
    if (std::fabs(d.value) <= reach) continue;
    off.push_back(fmt::format("{} = {}",
                              d.parameter.name == "flank_balance_x" ? "a_xy - a_xx tan(slope)"
                                                                    : "a_yy - 1 - a_xy tan(slope)",
                              with_error(d)));
  }
  if (off.empty()) return "";
  return fmt::format(
      "a description, no stress field: its flanks are out of balance, {}, where equilibrium asks "
      "for 0; cantelaube_continuous is the fit within equilibrium and yield",
      fmt::join(off, ", "));
}

}  // namespace

namespace {

void fit_each(const std::vector<FitModel>& asked, const FitOptions& options, EnsembleFits& out) {
  const FitData& data = out.observed.data;
  out.weights = weights_of(data);
  for (const FitModel& model : asked) {
    if (!model.absent.empty()) {
      out.absent.push_back(model);
      continue;
    }
    out.models.push_back(model);
    out.fits.push_back(fit(data, out.weights, out.models.back(), options));
  }
  if (out.models.empty()) {
    throw std::invalid_argument(fmt::format("fit.models: {}: {}; choose another model",
                                            out.absent.front().name, out.absent.front().absent));
  }
  SelectionOptions selection;
  selection.huber = options.huber;
  out.judgement = select(data, out.weights, out.models, out.fits, selection);
  out.judgement.measured = out.observed.measured;
}

}  // namespace

EnsembleFits fit_heaps(const FitSetup& setup, Observations heaps, int threads) {
  EnsembleFits out;
  out.observed = std::move(heaps);
  FitOptions options;
  options.huber = setup.huber;
  options.bootstrap = static_cast<int>(setup.bootstrap);
  options.threads = threads;
  FitSetup asked = setup;
  std::vector<std::string>& names = asked.models;
  // Beside constants that are free of equilibrium and yield stands the fit that is bound to both.
  const auto named = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (named("cantelaube") && !named("cantelaube_continuous")) {
    names.push_back("cantelaube_continuous");
  }
  out.asked = names;
  fit_each(models_of(asked, out.observed), options, out);
  out.judgement.noun = "pile";
  for (Fit& f : out.fits) {
    const std::string off =
        imbalance(f, out.observed.facts.slope_deg, out.observed.data.realizations());
    if (off.empty()) continue;
    f.note += (f.note.empty() ? "" : "; ") + off;
    out.judgement.doubts.push_back(fmt::format("{} is {}.", f.name, off));
  }
  for (const std::string& text : out.observed.warnings) {
    out.judgement.doubts.push_back(as_sentence(text));
  }
  out.elements = solve_elements(
      setup.finite_elements, out.models, out.fits, out.observed.data, out.weights,
      [&](const StressFunction& stress, bool) { return stress(out.observed.data.points); });
  return out;
}

EnsembleFits fit_layers(const FitSetup& setup, Observations layers, int threads) {
  EnsembleFits out;
  out.observed = std::move(layers);
  const FitData& data = out.observed.data;
  FitOptions options;
  options.bootstrap = static_cast<int>(setup.bootstrap);
  options.threads = threads;
  const auto seen = std::make_shared<const LayerSight>(places_of(data), *out.observed.kernel);
  out.asked = setup.models;
  fit_each(models_of_layers(out.asked, seen, out.observed.scale.h), options, out);
  out.judgement.noun = "layer";
  out.elements =
      solve_elements(setup.finite_elements, out.models, out.fits, data, out.weights,
                     [&](const StressFunction& stress, bool half_plane) {
                       return seen->places().pick(seen->seen(stress, half_plane), data.points);
                     });
  return out;
}

std::vector<Eigen::MatrixXd> models_at(const EnsembleFits& fits,
                                       const std::vector<std::string>& names,
                                       const Eigen::MatrixXd& points) {
  const Observations& observed = fits.observed;
  std::vector<FitModel> models;
  if (observed.specimen == Specimen::layer) {
    models = models_of_layers(
        fits.asked, std::make_shared<const LayerSight>(points, *observed.kernel), observed.scale.h);
  } else {
    const auto sight = heap_sight(points, observed);
    for (const RegistryEntry& entry :
         heap_entries_of(fits.asked, observed.facts, observed.scale.h)) {
      models.push_back(seen_entry(entry, observed.facts, sight));
    }
  }
  std::vector<Eigen::MatrixXd> out;
  for (const std::string& name : names) {
    out.push_back(
        find_fit_model(models, name).stress(points, parameters_of(fit_of(fits.fits, name))));
  }
  return out;
}

Eigen::MatrixXd model_on_maps(const EnsembleFits& fits, const std::string& name) {
  const Observations& observed = fits.observed;
  const StressMaps& m = observed.maps;
  std::vector<Eigen::Index> inside;
  for (Eigen::Index p = 0; p < m.points.rows(); ++p) {
    if (m.mean.row(p).allFinite()) inside.push_back(p);
  }
  Eigen::MatrixXd out = Eigen::MatrixXd::Constant(m.points.rows(), 3, kNan);
  if (inside.empty()) return out;
  const Eigen::MatrixXd seen = models_at(fits, {name}, m.points(inside, Eigen::all)).front();
  for (std::size_t k = 0; k < inside.size(); ++k) {
    out.row(inside[k]) = seen.row(static_cast<Eigen::Index>(k));
  }
  return out;
}

Comparison profiles_of(const EnsembleFits& fits) {
  const FitData& data = fits.observed.data;
  const double h = fits.observed.scale.h, unit = fits.observed.scale.unit;
  std::vector<Profile> profiles;
  std::vector<ModelProfiles> models;
  for (const FitModel& m : fits.models) models.push_back({m.name, m.label, m.name, {}});
  for (int c = 0; c < static_cast<int>(data.components.size()); ++c) {
    const std::string& name = data.components[static_cast<std::size_t>(c)];
    const double sign = name == "sigma_xy" ? 1 : -1;
    for (int level = 0; level < static_cast<int>(data.levels.size()); ++level) {
      const std::vector<int> rows = rows_at(data, c, level);
      if (rows.size() < 3) continue;
      const FitData part = rows_of(data, rows);
      Profile p;
      p.name = fmt::format("{} at {} h", name, data.levels[static_cast<std::size_t>(level)]);
      p.measured = fits.observed.measured;
      p.key = fmt::format("{}_{}", name, data.levels[static_cast<std::size_t>(level)]);
      p.quantity = (sign < 0 ? "-" : "") + name;
      p.depth = -part.points(0, 1) * h;
      p.x = h * part.points.col(0);
      p.samples = sign * unit * part.samples;
      p.mean = p.samples.rowwise().mean();
      p.error.resize(p.mean.size());
      if (fits.weights.errors_from == ErrorsFrom::data) {
        p.error = unit * fits.weights.error(rows);
      } else {
        for (Eigen::Index k = 0; k < p.mean.size(); ++k) {
          const Eigen::VectorXd row = p.samples.row(k);
          p.error[k] = spread_of({row.begin(), row.end()}).standard_error;
        }
      }
      p.independent_length = fits.observed.kernel->independent_length() * h;
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
      compare(std::move(profiles), std::move(models), fits.observed.scale, data.realizations());
  out.judgement = fits.judgement;
  return out;
}

}  // namespace grainfield::coupling
