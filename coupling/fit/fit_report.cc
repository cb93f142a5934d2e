#include "coupling/fit/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "continuum/closed/cantelaube.h"
#include "continuum/constants.h"
#include "coupling/fit/derived.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/fit/layer_models.h"
#include "coupling/fit/posteriors.h"
#include "coupling/observe/heap_rows.h"
#include "coupling/report/judgement.h"
#include "coupling/result/judgement.h"
#include "coupling/result/text_table.h"
#include "coupling/structure/yield.h"

namespace grainfield::coupling {
namespace {

constexpr std::size_t kDrawn = 4;   // models in a picture of heaps
constexpr double kSameLine = 1e-3;  // of the largest value: lines nearer than this are one

bool is_heap(const EnsembleFits& fits) { return fits.observed.specimen == Specimen::heap; }

const FittedParameter* parameter_of(const Fit& fit, const std::string& name) {
  for (const FittedParameter& p : fit.parameters) {
    if (p.parameter.name == name) return &p;
  }
  return nullptr;
}

std::string number_or_dash(double v) { return std::isfinite(v) ? fmt::format("{:.2g}", v) : "-"; }

// What follows from the constants of heaps.
std::vector<FittedParameter> derived_of(const EnsembleFits& fits, const Fit& fit) {
  if (!is_heap(fits)) return {};
  return derived_figures(fit, fits.observed.facts.slope_deg);
}

// The constants and, below those of their model, what follows from them.
std::vector<std::vector<std::string>> constants_rows(const EnsembleFits& fits) {
  std::vector<std::vector<std::string>> rows;
  for (const Fit& f : fits.fits) {
    for (auto& row : parameter_rows({f})) rows.push_back(std::move(row));
    for (const FittedParameter& d : derived_of(fits, f)) {
      rows.push_back({f.name, d.parameter.name, with_error(d), number_or_dash(d.covariance_error),
                      number_or_dash(d.bootstrap_error), "-", d.parameter.unit, "-",
                      "follows from those above"});
    }
  }
  return rows;
}

std::string weights_note(const EnsembleFits& fits) {
  const auto counted = [](int n, const char* what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  const FitData& data = fits.observed.data;
  const int levels = static_cast<int>(data.levels.size());
  const bool heap = is_heap(fits);
  std::string out = fmt::format("{} values of {} {} {}, each in units of {}", data.values(),
                                counted(data.realizations(), heap ? "pile" : "layer"),
                                heap ? "at" : "on", counted(levels, heap ? "height" : "level"),
                                heap ? "rho g h" : "F over its depth");
  if (!fits.weights.note.empty()) out += "; " + fits.weights.note;
  for (const FitModel& model : fits.absent) {
    out += fmt::format("; {} left out: {}", model.name, model.absent);
  }
  if (!fits.observed.note.empty()) out += "; " + fits.observed.note;
  return out;
}

// A line of the pictures: a model, and the names of all whose lines it would hide.
struct Line {
  std::string name, label;
};

// The best kDrawn of heaps. Models of one field (cantelaube_zero and bcc; cantelaube_continuous and
// osl_yield, up to the search's tolerance) share one.
std::vector<Line> lines_of(const EnsembleFits& fits) {
  std::vector<Line> out;
  if (!is_heap(fits)) {
    for (const Fit& f : fits.fits) out.push_back({f.name, f.name});
    return out;
  }
  for (const JudgedModel& s : fits.judgement.models) {
    const Eigen::VectorXd& values = fit_of(fits.fits, s.name).model;
    const auto same = std::find_if(out.begin(), out.end(), [&](const Line& line) {
      const Eigen::VectorXd& other = fit_of(fits.fits, line.name).model;
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

std::string frame_title(const EnsembleFits& fits, const std::string& component,
                        const std::string& level) {
  if (is_heap(fits)) {
    return fmt::format("{}{} at {} h", component == "sigma_xy" ? "" : "-", component, level);
  }
  return level == "base" ? "on the base" : "at the depth " + level + " h";
}

// Residuals of one model in standard errors along the levels.
Frame residual_frame(const EnsembleFits& fits, const std::string& model, int component) {
  const FitData& data = fits.observed.data;
  Frame frame;
  frame.title = data.components[static_cast<std::size_t>(component)];
  for (int level = 0; level < static_cast<int>(data.levels.size()); ++level) {
    const std::vector<int> rows = rows_at(data, component, level);
    if (rows.size() < 2) continue;
    frame.series.push_back({fmt::format("at {} h", data.levels[static_cast<std::size_t>(level)]),
                            data.points(rows, 0),
                            fit_of(fits.fits, model).residual(rows),
                            {},
                            false});
  }
  return frame;
}

// The expression over (sigma_xx + sigma_yy)^2. Nearer to the surface than `margin` the stress is
// made of single contacts and its direction means nothing: nan.
Eigen::VectorXd expression(const Observations& heaps, const Eigen::MatrixXd& stress,
                           double margin) {
  const HeapFacts& facts = heaps.facts;
  const Eigen::MatrixXd& at = heaps.maps.points;
  Eigen::VectorXd out = Eigen::VectorXd::Constant(stress.rows(), kNan);
  for (Eigen::Index p = 0; p < stress.rows(); ++p) {
    const double slope = (at(p, 0) < 0 ? facts.left() : facts.right()) * kDegree;
    if (depth_below_flank(facts, at(p, 0), at(p, 1)) * std::cos(slope) < margin) continue;
    const double sum = stress(p, 0) + stress(p, 1);
    out[p] = mohr_coulomb_expression(stress(p, 0), stress(p, 1), stress(p, 2), facts.friction()) /
             (sum * sum);
  }
  return out;
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

namespace {

void add_figures(const EnsembleFits& fits, Summary& summary) {
  const HeapFacts& facts = fits.observed.facts;
  summary["fit.values"] = fits.observed.data.values();
  if (is_heap(fits)) {
    summary["fit.slope_deg"] = facts.slope_deg;
    if (facts.left_deg > 0) {
      summary["fit.left_deg"] = facts.left_deg;
      summary["fit.right_deg"] = facts.right_deg;
      summary["fit.friction_deg"] = facts.friction();
    }
    if (std::isfinite(fits.observed.weight_over_wedge)) {
      summary["fit.weight_over_wedge"] = fits.observed.weight_over_wedge;
    }
    summary["fit.weights"] = weights_note(fits);
    summary["fit.warnings"] = fmt::format("{}", fmt::join(fits.observed.warnings, "; "));
  }
  add_parameters(summary, fits.fits);
  for (const Fit& f : fits.fits) {
    const std::string prefix = "fit." + f.name + ".";
    if (const FittedParameter* angle = parameter_of(f, "beta_hat_deg")) {
      summary[prefix + "branch"] = nearest_branch(facts.slope_deg, angle->value);
    }
    for (const FittedParameter& d : derived_of(fits, f)) {
      const std::string key = prefix + d.parameter.name;
      summary[key] = d.value;
      summary[key + ".error"] = d.error;
      summary[key + ".bootstrap_error"] = d.bootstrap_error;
    }
    if (parameter_of(f, "shear") != nullptr) {
      const Ratio rho = rho_of(f);
      summary[prefix + "rho"] = rho.value;
      summary[prefix + "rho.error"] = rho.error;
    }
  }
  add_ranking(summary, fits.judgement);
  add_elements(summary, fits.elements);
}

// One of the two writers of a table.
using TableWriter = std::string (*)(const std::vector<std::string>&,
                                    const std::vector<std::vector<std::string>>&);

std::string constants_and_elements(const EnsembleFits& fits, TableWriter table) {
  std::string out = table(parameter_header(), constants_rows(fits));
  if (!fits.elements.empty() || !is_heap(fits)) {
    out += '\n' + table(elements_header(), element_rows(fits.elements));
  }
  return out;
}

}  // namespace

void add_fits(StudyResult& result, const EnsembleFits& fits) {
  add_figures(fits, result.summary);
  result.comparison.judgement = fits.judgement;
  result.constants = constants_text(fits.fits);
  result.texts = {
      {"fits.csv", parameters_csv(fits.fits)},
      {"fits.md", fmt::format("{}\n{}.\n\n{}", judgement_text(fits.judgement), weights_note(fits),
                              constants_and_elements(fits, markdown_table))},
      {"fits.tex", fmt::format("% {}\n{}\n{}", weights_note(fits), judgement_latex(fits.judgement),
                               constants_and_elements(fits, latex_table))}};
}

namespace {

// Models along one level; where the data have few places, between them too.
void add_model_lines(const EnsembleFits& fits, const std::vector<Line>& lines,
                     const std::vector<int>& rows, const std::string& component, Frame& frame) {
  const Eigen::MatrixXd places = fits.observed.data.points(rows, Eigen::all);
  const double sign = component == "sigma_xy" ? 1 : -1;
  if (places.rows() >= kFewPlaces) {
    for (const Line& line : lines) {
      frame.series.push_back(
          {line.label, places.col(0), sign * fit_of(fits.fits, line.name).model(rows), {}, false});
    }
    return;
  }
  const std::vector<std::string> columns{"sigma_xx", "sigma_yy", "sigma_xy"};
  const auto column = std::find(columns.begin(), columns.end(), component) - columns.begin();
  const Eigen::MatrixXd between = drawn_places(places);
  std::vector<std::string> names;
  for (const Line& line : lines) names.push_back(line.name);
  const std::vector<Eigen::MatrixXd> seen = models_at(fits, names, between);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    frame.series.push_back({lines[k].label, between.col(0), sign * seen[k].col(column), {}, false});
  }
}

}  // namespace

std::vector<Frame> profile_frames(const EnsembleFits& fits, const std::string& component,
                                  const std::vector<std::string>& only) {
  const FitData& data = fits.observed.data;
  const double sign = component == "sigma_xy" ? 1 : -1;
  const auto at = std::find(data.components.begin(), data.components.end(), component);
  const int number = static_cast<int>(at - data.components.begin());
  const Eigen::VectorXd mean = data.mean();
  const std::vector<Line> lines = lines_of(fits);
  std::vector<Frame> out;
  for (std::size_t level = 0; level < data.levels.size(); ++level) {
    const std::string& name = data.levels[level];
    if (!only.empty() && std::find(only.begin(), only.end(), name) == only.end()) continue;
    const std::vector<int> rows = rows_at(data, number, static_cast<int>(level));
    if (rows.size() < 3) continue;
    Series grains{fits.observed.measured ? "measured" : "grains", data.points(rows, 0),
                  sign * mean(rows), fits.weights.error(rows), true};
    if (!fits.weights.known()) grains.error.resize(0);
    Frame frame{frame_title(fits, component, name), {grains}};
    add_model_lines(fits, lines, rows, component, frame);
    out.push_back(std::move(frame));
  }
  return out;
}

std::vector<Section> fit_map_sections(const EnsembleFits& fits, const std::string& name,
                                      const std::string& of) {
  const Observations& seen = fits.observed;
  const StressMaps& m = seen.maps;
  if (m.points.rows() == 0 || !m.mean.array().isFinite().any()) return {};
  const Eigen::MatrixXd model = model_on_maps(fits, name);
  if (!is_heap(fits)) {
    return map_sections(m, model, name,
                        {"F/h",
                         "Response to the load, one colour scale for all three; it ends at the "
                         "99 % quantile. The model is smoothed with the kernel of the averaging.",
                         of});
  }
  std::vector<Section> out = map_sections(
      m, model, name,
      {"ρ g h",
       "Every pile scaled by its own h and rho g h; one colour scale for all three, which ends at "
       "the 99 % quantile. The model has its fitted constants and is smoothed with the kernel of "
       "the averaging. Without values nearer to the floor than the averaging width.",
       of});
  const double margin = seen.kernel->range() / 2;
  Picture yield = maps("Mohr-Coulomb expression", "x / h", "y / h", "expression",
                       {{"grains", m.columns, m.rows, m.points, expression(seen, m.mean, margin)},
                        {name, m.columns, m.rows, m.points, expression(seen, model, margin)}});
  yield.caption = fmt::format(
      "((σxx - σyy)² + 4σxy²) / (σxx + σyy)² - sin²φ with φ = {:.1f} degrees (Roul 4.2), of the "
      "mean stress: 0 at the limit of friction, below 0 (blue) inside, above 0 (red) beyond it. "
      "Without values nearer to surface or floor than the averaging width.",
      seen.facts.friction());
  out.emplace_back(std::move(yield));
  return out;
}

std::vector<Section> fit_pictures(const EnsembleFits& fits) {
  std::vector<Section> out;
  const bool heap = is_heap(fits);
  const Observations& seen = fits.observed;
  const char* const from = heap ? "x / h (apex at 0)" : "x / h (load at 0)";
  const std::string best = fits.judgement.best;
  // The vertical stress first: it is what the report begins with.
  std::vector<std::string> components = seen.data.components;
  std::stable_partition(components.begin(), components.end(),
                        [](const std::string& name) { return name == "sigma_yy"; });
  for (const std::string& component : components) {
    std::vector<Frame> frames = profile_frames(fits, component);
    if (frames.empty()) continue;
    Picture picture =
        heap ? curves((seen.measured ? "Measurement" : "Grains") +
                          (" and the best models: " + component),
                      from, "ρ g h", frames)
             : curves(fmt::format("Response of {} to the load, and all models", component), from,
                      fmt::format("{}σ_{{{}}}  (F/h)", component == "sigma_xy" ? "" : "-",
                                  component.substr(6)),
                      frames);
    picture.caption =
        heap ? "Every pile scaled by its own h and rho g h."
             : fmt::format(
                   "Loaded less unloaded, h = {:.4g} m, F = {:.4g} N. The models have their fitted "
                   "constants and are smoothed with the kernel of the averaging; finite elements "
                   "lie on their closed forms (table below).",
                   seen.scale.h, seen.scale.unit * seen.scale.h);
    picture.caption += fmt::format(" {}.", weights_note(fits));
    out.emplace_back(std::move(picture));
  }
  for (Section& section : fit_map_sections(fits, best)) out.push_back(std::move(section));
  if (heap && fits.weights.known()) {
    std::vector<Frame> frames;
    for (int c = 0; c < static_cast<int>(seen.data.components.size()); ++c) {
      Frame frame = residual_frame(fits, best, c);
      if (!frame.series.empty()) frames.push_back(std::move(frame));
    }
    if (!frames.empty()) {
      Picture picture = curves(
          "Where " + best + " fails, over the standard error", from,
          fmt::format("({} - model) / standard error", seen.measured ? "measured" : "grains"),
          frames);
      picture.caption = "Beyond 2 or 3 in a row the model is wrong there.";
      out.emplace_back(std::move(picture));
    }
  }
  std::vector<const Fit*> ranked;
  for (const JudgedModel& s : fits.judgement.models) ranked.push_back(&fit_of(fits.fits, s.name));
  for (Section& section : posterior_sections(ranked, seen.data.realizations())) {
    out.push_back(std::move(section));
  }
  return out;
}

std::vector<Section> fit_tables(const EnsembleFits& fits, const std::string& of) {
  std::vector<Section> out;
  const auto titled = [&](const std::string& title) {
    return of.empty() ? title : of + static_cast<char>(std::tolower(title[0])) + title.substr(1);
  };
  if (!of.empty()) out = judgement_tables(fits.judgement, of);
  out.emplace_back(Table{titled("Fitted constants"), constants_note(), parameter_header(),
                         constants_rows(fits)});
  if (!fits.elements.empty()) {
    out.emplace_back(Table{titled("Finite elements with the fitted constants"),
                           "Solved by deal.II with the constants of the fit, on the same points.",
                           elements_header(), element_rows(fits.elements)});
  }
  return out;
}

}  // namespace grainfield::coupling
