#include "coupling/fit/heap_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "continuum/closed/cantelaube.h"
#include "continuum/constants.h"
#include "coupling/fit/derived.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/fit/heap_maps.h"
#include "coupling/fit/posteriors.h"

namespace grainfield::coupling {
namespace {

constexpr std::size_t kDrawn = 4;   // models in a picture
constexpr double kSameLine = 1e-3;  // of the largest value: lines nearer than this are one

const FittedParameter* parameter_of(const Fit& fit, const std::string& name) {
  for (const FittedParameter& p : fit.parameters) {
    if (p.parameter.name == name) return &p;
  }
  return nullptr;
}

std::string number_or_dash(double v) { return std::isfinite(v) ? fmt::format("{:.2g}", v) : "-"; }

// The constants and, below those of their model, what follows from them.
std::vector<std::vector<std::string>> constants_rows(const HeapFits& fits) {
  std::vector<std::vector<std::string>> rows;
  for (const Fit& f : fits.fits) {
    for (auto& row : parameter_rows({f})) rows.push_back(std::move(row));
    for (const FittedParameter& d : derived_figures(f, fits.heaps.facts.slope_deg)) {
      rows.push_back({f.name, d.parameter.name, with_error(d), number_or_dash(d.covariance_error),
                      number_or_dash(d.bootstrap_error), "-", d.parameter.unit, "-",
                      "follows from those above"});
    }
  }
  return rows;
}

std::string weights_note(const HeapFits& fits) {
  const auto counted = [](int n, const char* what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  std::string out = fmt::format("{} values of {} at {}", fits.heaps.data.values(),
                                counted(fits.heaps.data.realizations(), "pile"),
                                counted(static_cast<int>(fits.heaps.data.levels.size()), "height"));
  out += ", each in units of rho g h";
  if (!fits.weights.note.empty()) out += "; " + fits.weights.note;
  for (const FitModel& model : fits.absent) {
    out += fmt::format("; {} left out: {}", model.name, model.absent);
  }
  if (!fits.heaps.note.empty()) out += "; " + fits.heaps.note;
  return out;
}

// A line of the pictures: a model, and the names of all whose lines it would hide.
struct Line {
  std::string name, label;
};

// The best kDrawn lines. Models of one field (cantelaube_zero and bcc; cantelaube_continuous and
// osl_yield, up to the search's tolerance) share one.
std::vector<Line> lines_of(const HeapFits& fits) {
  std::vector<Line> out;
  for (const Score& s : fits.selection.ranking) {
    const Eigen::VectorXd& values = fit_named(fits.fits, s.name).model;
    const auto same = std::find_if(out.begin(), out.end(), [&](const Line& line) {
      const Eigen::VectorXd& other = fit_named(fits.fits, line.name).model;
      return (values - other).cwiseAbs().maxCoeff() < kSameLine * other.cwiseAbs().maxCoeff();
    });
    if (same != out.end()) {
      same->label += ", " + s.name;
    } else if (out.size() < kDrawn) {
      out.push_back({s.name, s.name});
    }
  }
  return out;
}

// The component along one height: the piles and some models.
Frame frame_of(const HeapFits& fits, int component, int level, const std::vector<Line>& models) {
  const FitData& data = fits.heaps.data;
  std::vector<Eigen::Index> rows;
  for (int k = 0; k < data.values(); ++k) {
    if (data.component[static_cast<std::size_t>(k)] == component &&
        data.level[static_cast<std::size_t>(k)] == level) {
      rows.push_back(k);
    }
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  const std::string& name = data.components[static_cast<std::size_t>(component)];
  const double sign = name == "sigma_xy" ? 1 : -1;
  Frame frame;
  frame.title = fmt::format("{}{} at {} h", sign < 0 ? "-" : "", name,
                            data.levels[static_cast<std::size_t>(level)]);
  Series grains{"grains", Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n), true};
  const Eigen::VectorXd mean = data.mean();
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index row = rows[static_cast<std::size_t>(k)];
    grains.x[k] = data.points(row, 0);
    grains.y[k] = sign * mean[row];
    grains.error[k] = fits.weights.error[row];
  }
  if (!fits.weights.known()) grains.error.resize(0);
  frame.series.push_back(grains);
  for (const Line& model : models) {
    Series s{model.label, grains.x, Eigen::VectorXd(n), {}, false};
    for (Eigen::Index k = 0; k < n; ++k) {
      s.y[k] = sign * fit_named(fits.fits, model.name).model[rows[static_cast<std::size_t>(k)]];
    }
    frame.series.push_back(std::move(s));
  }
  return frame;
}

// Residuals of one model in standard errors along the heights.
Frame residual_frame(const HeapFits& fits, const std::string& model, int component) {
  const FitData& data = fits.heaps.data;
  Frame frame;
  frame.title = data.components[static_cast<std::size_t>(component)];
  for (int level = 0; level < static_cast<int>(data.levels.size()); ++level) {
    std::vector<double> x, y;
    for (int k = 0; k < data.values(); ++k) {
      if (data.component[static_cast<std::size_t>(k)] != component ||
          data.level[static_cast<std::size_t>(k)] != level) {
        continue;
      }
      x.push_back(data.points(k, 0));
      y.push_back(fit_named(fits.fits, model).residual[k]);
    }
    Series s{
        fmt::format("at {} h", data.levels[static_cast<std::size_t>(level)]), {}, {}, {}, false};
    s.x = Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    s.y = Eigen::Map<Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size()));
    if (s.x.size() > 1) frame.series.push_back(std::move(s));
  }
  return frame;
}

}  // namespace

std::string nearest_branch(double slope_deg, double beta_hat_deg) {
  const std::vector<std::pair<std::string, continuum::CoreBranch>> branches{
      {"minus", continuum::CoreBranch::minus},
      {"zero", continuum::CoreBranch::zero},
      {"plus", continuum::CoreBranch::plus}};
  std::string best;
  double least = 0;
  for (const auto& [name, branch] : branches) {
    const double off =
        std::fabs(beta_hat_deg - continuum::core_angle(slope_deg * kDegree, branch) / kDegree);
    if (best.empty() || off < least) {
      least = off;
      best = name;
    }
  }
  return best;
}

void add_fits(Summary& summary, const HeapFits& fits) {
  const double slope = fits.heaps.facts.slope_deg;
  summary["fit.values"] = fits.heaps.data.values();
  summary["fit.slope_deg"] = slope;
  if (fits.heaps.facts.left_deg > 0) {
    summary["fit.left_deg"] = fits.heaps.facts.left_deg;
    summary["fit.right_deg"] = fits.heaps.facts.right_deg;
    summary["fit.friction_deg"] = fits.heaps.facts.friction();
  }
  summary["fit.weights"] = weights_note(fits);
  summary["fit.warnings"] = fmt::format("{}", fmt::join(fits.heaps.warnings, "; "));
  add_parameters(summary, fits.fits);
  for (const Fit& f : fits.fits) {
    const std::string prefix = "fit." + f.name + ".";
    if (const FittedParameter* angle = parameter_of(f, "beta_hat_deg")) {
      summary[prefix + "branch"] = nearest_branch(slope, angle->value);
    }
    for (const FittedParameter& d : derived_figures(f, slope)) {
      const std::string key = prefix + d.parameter.name;
      summary[key] = d.value;
      summary[key + ".error"] = d.error;
      summary[key + ".bootstrap_error"] = d.bootstrap_error;
    }
  }
  add_ranking(summary, fits.selection);
  summary["verdict.best_model"] = fits.selection.ranking.front().name;
  summary["verdict.distinguishable"] = fits.selection.distinguishable ? "yes" : "no";
}

std::string fits_markdown(const HeapFits& fits) {
  std::string doubts;
  for (const std::string& text : fits.heaps.warnings) doubts += "Warning: " + text + ".\n\n";
  return fmt::format("{}\n\n{}.\n\n{}{}\n{}", fits.selection.sentence, weights_note(fits), doubts,
                     markdown_table(ranking_header(), ranking_rows(fits.fits, fits.selection)),
                     markdown_table(parameter_header(), constants_rows(fits)));
}

std::string fits_tex(const HeapFits& fits) {
  return fmt::format("% {}\n{}\n{}", weights_note(fits),
                     tex_table(ranking_header(), ranking_rows(fits.fits, fits.selection)),
                     tex_table(parameter_header(), constants_rows(fits)));
}

std::vector<Section> fit_sections(const HeapFits& fits) {
  std::vector<Section> out;
  const std::vector<Line> lines = lines_of(fits);
  const std::string& best = lines.front().name;
  const FitData& data = fits.heaps.data;
  for (int c = 0; c < static_cast<int>(data.components.size()); ++c) {
    std::vector<Frame> frames;
    for (int level = 0; level < static_cast<int>(data.levels.size()); ++level) {
      Frame frame = frame_of(fits, c, level, lines);
      if (frame.series.front().x.size() > 2) frames.push_back(std::move(frame));
    }
    if (frames.empty()) continue;
    Picture picture = curves(
        fmt::format("Grains and the best models: {}", data.components[static_cast<std::size_t>(c)]),
        "x / h (apex at 0)", "ρ g h", frames);
    picture.caption = fmt::format(
        "Every pile scaled by its own h and rho g h. The grey band is one standard error on "
        "either side. {}.",
        weights_note(fits));
    out.emplace_back(std::move(picture));
  }
  for (Section& section : heap_map_sections(fits, best)) {
    out.push_back(std::move(section));
  }
  if (fits.weights.known()) {
    std::vector<Frame> frames;
    for (int c = 0; c < static_cast<int>(data.components.size()); ++c) {
      Frame frame = residual_frame(fits, best, c);
      if (!frame.series.empty()) frames.push_back(std::move(frame));
    }
    if (!frames.empty()) {
      Picture picture = curves("Where the best model fails: " + best, "x / h (apex at 0)",
                               "(grains - model) / standard error", frames);
      picture.caption = "Beyond 2 or 3 in a row the model is wrong there.";
      out.emplace_back(std::move(picture));
    }
  }
  std::vector<const Fit*> ranked;
  for (const Score& s : fits.selection.ranking) ranked.push_back(&fit_named(fits.fits, s.name));
  for (Section& section : posterior_sections(ranked, data.realizations())) {
    out.push_back(std::move(section));
  }
  out.emplace_back(
      Table{"Ranking", ranking_note(), ranking_header(), ranking_rows(fits.fits, fits.selection)});
  out.emplace_back(
      Table{"Fitted constants", constants_note(), parameter_header(), constants_rows(fits)});
  return out;
}

}  // namespace grainfield::coupling
