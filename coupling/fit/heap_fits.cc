#include "coupling/fit/heap_fits.h"

#include <fmt/format.h>

#include <stdexcept>

#include "coupling/compare/significance.h"

namespace grainfield::coupling {

HeapFits fit_heaps(const FitSetup& setup, HeapData heaps, int threads) {
  HeapFits out;
  out.heaps = std::move(heaps);
  const FitData& data = out.heaps.data;
  out.covariance = covariance_of(data, setup.covariance);
  const std::vector<FitModel> known = heap_models(out.heaps.facts);
  FitOptions options;
  options.huber = setup.huber;
  options.bootstrap = static_cast<int>(setup.bootstrap);
  options.threads = threads;
  for (const std::string& name : setup.models) {
    const FitModel& model = find_fit_model(known, name);
    if (!model.absent.empty()) {
      out.absent.push_back(model);
      continue;
    }
    out.models.push_back(model);
    out.fits.push_back(fit(data, out.covariance, out.models.back(), options));
  }
  if (out.models.empty()) {
    throw std::invalid_argument(fmt::format("fit.models: {}: {}; choose another model",
                                            out.absent.front().name, out.absent.front().absent));
  }
  SelectionOptions selection;
  selection.huber = setup.huber;
  out.selection = select(data, out.covariance, out.models, out.fits, selection);
  return out;
}

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

}  // namespace grainfield::coupling
