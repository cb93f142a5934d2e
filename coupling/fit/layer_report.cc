#include "coupling/fit/layer_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/fit/fit_tables.h"
#include "coupling/fit/layer_models.h"
#include "coupling/fit/posteriors.h"

namespace grainfield::coupling {
namespace {

// The shared ranking with the type of the equations beside the name.
std::vector<std::string> layer_ranking_header() {
  std::vector<std::string> header = ranking_header();
  header.insert(header.begin() + 1, "equations");
  return header;
}

std::vector<std::vector<std::string>> layer_ranking_rows(const LayerFits& fits) {
  auto rows = ranking_rows(fits.fits, fits.selection);
  for (auto& row : rows) row.insert(row.begin() + 1, type_of_equations(row.front()));
  return rows;
}

std::string weights_note(const LayerFits& fits) {
  const std::string out = fmt::format(
      "{} values of {} layers on {} levels, each in units of F over its depth",
      fits.layers.data.values(), fits.layers.data.realizations(), fits.layers.data.levels.size());
  return fits.weights.note.empty() ? out : out + "; " + fits.weights.note;
}

std::string level_title(const std::string& level) {
  return level == "base" ? "on the base" : "at the depth " + level + " h";
}

}  // namespace

void add_layer_fits(Summary& summary, const LayerFits& fits) {
  summary["fit.values"] = static_cast<double>(fits.layers.data.values());
  add_parameters(summary, fits.fits);
  add_ranking(summary, fits.selection);
  for (const Fit& f : fits.fits) {
    const Ratio rho = rho_of(f);
    if (f.name.rfind("orthotropic_layer_rough", 0) == 0) {
      summary["fit." + f.name + ".rho"] = rho.value;
      summary["fit." + f.name + ".rho.error"] = rho.error;
    }
  }
  add_elements(summary, fits.elements);
  summary["verdict.best_model"] = fits.verdict.model;
  summary["verdict.distinguishable"] = fits.verdict.alone ? "yes" : "no";
  summary["verdict.equations"] = fits.verdict.equations;
  summary["verdict.agrees"] = fits.verdict.agrees ? "yes" : "no";
  summary["verdict.sentence"] = fits.verdict.sentence;
}

std::string layer_fits_markdown(const LayerFits& fits) {
  return fmt::format("{}\n\n{}.\n\n{}\n{}\n{}", fits.verdict.sentence, weights_note(fits),
                     markdown_table(layer_ranking_header(), layer_ranking_rows(fits)),
                     markdown_table(parameter_header(), parameter_rows(fits.fits)),
                     markdown_table(elements_header(), element_rows(fits.elements)));
}

std::string layer_fits_tex(const LayerFits& fits) {
  return fmt::format("% {}\n{}\n{}\n{}", weights_note(fits),
                     tex_table(layer_ranking_header(), layer_ranking_rows(fits)),
                     tex_table(parameter_header(), parameter_rows(fits.fits)),
                     tex_table(elements_header(), element_rows(fits.elements)));
}

std::vector<Frame> layer_frames(const LayerFits& fits, const std::string& component,
                                const std::vector<std::string>& only) {
  const FitData& data = fits.layers.data;
  const double sign = component == "sigma_xy" ? 1 : -1;
  const Eigen::VectorXd mean = data.mean();
  std::vector<Frame> out;
  for (std::size_t level = 0; level < data.levels.size(); ++level) {
    if (!only.empty() && std::find(only.begin(), only.end(), data.levels[level]) == only.end()) {
      continue;
    }
    std::vector<Eigen::Index> rows;
    for (int k = 0; k < data.values(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (data.components[static_cast<std::size_t>(data.component[at])] == component &&
          data.level[at] == static_cast<int>(level)) {
        rows.push_back(k);
      }
    }
    if (rows.size() < 3) continue;
    const auto n = static_cast<Eigen::Index>(rows.size());
    Series grains{"grains", Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n), true};
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index row = rows[static_cast<std::size_t>(k)];
      grains.x[k] = data.points(row, 0);
      grains.y[k] = sign * mean[row];
      grains.error[k] = fits.weights.error[row];
    }
    if (!fits.weights.known()) grains.error.resize(0);
    Frame frame{level_title(data.levels[level]), {grains}};
    for (const Fit& f : fits.fits) {
      Series s{f.name, grains.x, Eigen::VectorXd(n), {}, false};
      for (Eigen::Index k = 0; k < n; ++k) {
        s.y[k] = sign * f.model[rows[static_cast<std::size_t>(k)]];
      }
      frame.series.push_back(std::move(s));
    }
    out.push_back(std::move(frame));
  }
  return out;
}

std::vector<Section> layer_map_sections(const LayerFits& fits, const std::string& model,
                                        const std::string& of) {
  return map_sections(
      fits.maps, model_on_maps(fits.maps, fits.layers, fit_named(fits.fits, model)), model,
      {"F/h",
       "Response to the load, one colour scale for all three; it ends at the 99 % quantile. The "
       "model is smoothed with the kernel of the averaging.",
       of});
}

std::vector<Section> layer_pictures(const LayerFits& fits) {
  std::vector<Section> out;
  for (const std::string& component : fits.layers.data.components) {
    std::vector<Frame> frames = layer_frames(fits, component);
    if (frames.empty()) continue;
    const bool shear = component == "sigma_xy";
    Picture picture = curves(
        fmt::format("Response of {} to the load, and all models", component), "x / h (load at 0)",
        fmt::format("{}σ_{{{}}}  (F/h)", shear ? "" : "-", component.substr(6)), frames);
    picture.caption = fmt::format(
        "Loaded less unloaded, h = {:.4g} m, F = {:.4g} N. The models have their fitted constants "
        "and are smoothed with the kernel of the averaging; finite elements lie on their closed "
        "forms (table below). The grey band is one standard error on either side. {}.",
        fits.layers.depth, fits.layers.force, weights_note(fits));
    out.emplace_back(std::move(picture));
  }
  const std::string& best = fits.verdict.model;
  for (Section& s : layer_map_sections(fits, best)) {
    out.push_back(std::move(s));
  }
  std::vector<const Fit*> ranked;
  for (const Score& s : fits.selection.ranking) ranked.push_back(&fit_named(fits.fits, s.name));
  for (Section& s : posterior_sections(ranked, fits.layers.data.realizations())) {
    out.push_back(std::move(s));
  }
  return out;
}

std::vector<Section> layer_tables(const LayerFits& fits, const std::string& of) {
  std::vector<Section> out;
  out.emplace_back(Table{of.empty() ? "Ranking" : of + "ranking",
                         ranking_note() + " " + weights_note(fits) + ".", layer_ranking_header(),
                         layer_ranking_rows(fits)});
  out.emplace_back(Table{of.empty() ? "Fitted constants" : of + "fitted constants",
                         constants_note(), parameter_header(), parameter_rows(fits.fits)});
  if (!fits.elements.empty()) {
    out.emplace_back(Table{of.empty() ? "Finite elements with the fitted constants"
                                      : of + "finite elements with the fitted constants",
                           "Solved by deal.II with the constants of the fit, on the same points.",
                           elements_header(), element_rows(fits.elements)});
  }
  return out;
}

}  // namespace grainfield::coupling
