#include "coupling/fit/heap_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "continuum/closed/cantelaube.h"
#include "continuum/closed/osl.h"

namespace grainfield::coupling {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kDrawn = 4;  // models in a picture

const Fit& fit_of(const HeapFits& fits, const std::string& name) {
  return *std::find_if(fits.fits.begin(), fits.fits.end(),
                       [&](const Fit& f) { return f.name == name; });
}

const FittedParameter* parameter_of(const Fit& fit, const std::string& name) {
  for (const FittedParameter& p : fit.parameters) {
    if (p.parameter.name == name) return &p;
  }
  return nullptr;
}

// A number that follows from the parameters, with errors by linear propagation: their correlations
// are those of the covariance in both.
void add_derived(Summary& summary, const std::string& key, const Fit& fit,
                 const std::function<double(const Eigen::VectorXd&)>& of) {
  const auto n = static_cast<Eigen::Index>(fit.parameters.size());
  Eigen::VectorXd at(n), gradient(n), error(n), drawn(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const FittedParameter& p = fit.parameters[static_cast<std::size_t>(k)];
    at[k] = p.value;
    error[k] = p.error;
    drawn[k] = p.bootstrap_error;
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    const double h = 1e-6 * std::max(1.0, std::fabs(at[k]));
    Eigen::VectorXd more = at, less = at;
    more[k] += h;
    less[k] -= h;
    gradient[k] = (of(more) - of(less)) / (2 * h);
  }
  const auto spread = [&](const Eigen::VectorXd& errors) {
    const Eigen::VectorXd part = gradient.cwiseProduct(errors);
    return std::sqrt(std::max(0.0, part.dot(fit.correlation * part)));
  };
  const bool known = error.allFinite() && fit.correlation.allFinite();
  summary[key] = of(at);
  summary[key + ".error"] = known ? spread(error) : std::nan("");
  summary[key + ".bootstrap_error"] = known && drawn.allFinite() ? spread(drawn) : std::nan("");
}

std::string number(double v) { return std::isfinite(v) ? fmt::format("{:.6g}", v) : "nan"; }

std::string with_error(const FittedParameter& p) {
  if (!std::isfinite(p.error)) return fmt::format("{:.3g} (no error)", p.value);
  const int digits =
      std::clamp(1 - static_cast<int>(std::floor(std::log10(std::max(p.error, 1e-12)))), 0, 8);
  return fmt::format("{:.{}f} +- {:.{}f}", p.value, digits, p.error, digits);
}

// Rows of the ranking: model, free numbers, chi2/dof, ...
std::vector<std::vector<std::string>> ranking_rows(const HeapFits& fits) {
  std::vector<std::vector<std::string>> rows;
  for (const Score& s : fits.selection.ranking) {
    const Fit& f = fit_of(fits, s.name);
    rows.push_back({s.name, fmt::format("{}", f.parameters.size()), number(f.chi2_per_dof),
                    fmt::format("{:.1f}", s.aicc_difference),
                    std::isfinite(s.behind_error)
                        ? fmt::format("{:.3g} +- {:.2g}", s.behind, s.behind_error)
                        : "-",
                    std::isfinite(s.level_score) ? fmt::format("{:.3g}", s.level_score) : "-",
                    fmt::format("{:.1f} %", 100 * f.rel_l2), s.supported ? "yes" : "no"});
  }
  return rows;
}

const std::vector<std::string> kRankingHeader{"model",       "free numbers", "chi2/dof",
                                              "AICc behind", "CV behind",    "CV over heights",
                                              "relative L2", "supported"};

std::vector<std::vector<std::string>> parameter_rows(const HeapFits& fits) {
  std::vector<std::vector<std::string>> rows;
  for (const Fit& f : fits.fits) {
    for (std::size_t k = 0; k < f.parameters.size(); ++k) {
      const FittedParameter& p = f.parameters[k];
      // Its strongest correlation with another.
      std::string with = "-";
      double strongest = 0;
      for (std::size_t j = 0; j < f.parameters.size(); ++j) {
        const double r = f.correlation(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j));
        if (j == k || !(std::fabs(r) > std::fabs(strongest))) continue;
        strongest = r;
        with = fmt::format("{:.2f} with {}", r, f.parameters[j].parameter.name);
      }
      rows.push_back(
          {f.name, p.parameter.name, with_error(p),
           std::isfinite(p.bootstrap_error) ? fmt::format("{:.2g}", p.bootstrap_error) : "-",
           p.parameter.unit, with, p.at_bound ? "at its bound" : ""});
    }
  }
  return rows;
}

const std::vector<std::string> kParameterHeader{
    "model", "parameter", "value", "bootstrap error", "unit", "strongest correlation", "note"};

std::string markdown_table(const std::vector<std::string>& header,
                           const std::vector<std::vector<std::string>>& rows) {
  std::string out = fmt::format("| {} |\n|{}\n", fmt::join(header, " | "), [&] {
    std::string rule;
    for (std::size_t k = 0; k < header.size(); ++k) rule += "---|";
    return rule;
  }());
  for (const auto& row : rows) out += fmt::format("| {} |\n", fmt::join(row, " | "));
  return out;
}

std::string tex_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '_' || c == '%') out += '\\';
    out += c;
  }
  const std::size_t at = out.find("+-");
  return at == std::string::npos ? out : out.replace(at, 2, "$\\pm$");
}

std::string tex_table(const std::vector<std::string>& header,
                      const std::vector<std::vector<std::string>>& rows) {
  const auto line = [](const std::vector<std::string>& cells) {
    std::vector<std::string> out;
    for (const std::string& cell : cells) out.push_back(tex_escaped(cell));
    return fmt::format("{} \\\\\n", fmt::join(out, " & "));
  };
  std::string out = fmt::format("\\begin{{tabular}}{{{}}}\n\\hline\n{}\\hline\n",
                                std::string(header.size(), 'l'), line(header));
  for (const auto& row : rows) out += line(row);
  return out + "\\hline\n\\end{tabular}\n";
}

std::string weights_note(const HeapFits& fits) {
  const Covariance& c = fits.covariance;
  std::string out = fmt::format(
      "{} values of {} piles at {} heights; {} covariance, correlation length {:.3g} h, {:.0f} "
      "effective values",
      fits.heaps.data.values(), fits.heaps.data.realizations(), fits.heaps.data.levels.size(),
      c.kind, c.correlation_length, c.effective_values);
  if (!c.note.empty()) out += "; " + c.note;
  for (const FitModel& model : fits.absent) {
    out += fmt::format("; {} left out: {}", model.name, model.absent);
  }
  return fits.heaps.note.empty() ? out : out + "; " + fits.heaps.note;
}

// The component along one height: the piles and some models.
Frame frame_of(const HeapFits& fits, int component, int level,
               const std::vector<std::string>& models) {
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
    grains.error[k] = std::sqrt(fits.covariance.of_mean(row, row));
  }
  if (fits.covariance.kind == "unknown") grains.error.resize(0);
  frame.series.push_back(grains);
  for (const std::string& model : models) {
    Series s{model, grains.x, Eigen::VectorXd(n), {}, false};
    for (Eigen::Index k = 0; k < n; ++k) {
      s.y[k] = sign * fit_of(fits, model).model[rows[static_cast<std::size_t>(k)]];
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
      y.push_back(fit_of(fits, model).residual[k]);
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
  summary["fit.covariance"] = fits.covariance.kind;
  summary["fit.correlation_length"] = fits.covariance.correlation_length;
  summary["fit.effective_values"] = fits.covariance.effective_values;
  for (const Fit& f : fits.fits) {
    const std::string prefix = "fit." + f.name + ".";
    for (const FittedParameter& p : f.parameters) {
      summary[prefix + p.parameter.name] = p.value;
      summary[prefix + p.parameter.name + ".error"] = p.error;
      summary[prefix + p.parameter.name + ".bootstrap_error"] = p.bootstrap_error;
    }
    if (const FittedParameter* angle = parameter_of(f, "beta_hat_deg")) {
      summary[prefix + "branch"] = nearest_branch(slope, angle->value);
    }
    const FittedParameter *eta = parameter_of(f, "eta"), *mu = parameter_of(f, "mu");
    if (mu != nullptr) {
      const double phi = slope * kDegree;
      const auto closure = [=](const Eigen::VectorXd& p) {
        if (p.size() == 2) return continuum::Closure{p[0], p[1]};
        return continuum::Closure{continuum::eta_at_yield(phi, p[0]), p[0]};
      };
      add_derived(summary, prefix + "K", f,
                  [=](const Eigen::VectorXd& p) { return continuum::ratio_of(closure(p)).K; });
      add_derived(summary, prefix + "tau_deg", f, [=](const Eigen::VectorXd& p) {
        return continuum::ratio_of(closure(p)).tau / kDegree;
      });
      if (eta == nullptr) {
        add_derived(summary, prefix + "eta", f,
                    [=](const Eigen::VectorXd& p) { return closure(p).eta; });
      }
    }
    summary[prefix + "chi2_per_dof"] = f.chi2_per_dof;
    summary[prefix + "rel_l2"] = f.rel_l2;
    summary[prefix + "note"] = f.note;
  }
  for (const Score& s : fits.selection.ranking) {
    const std::string prefix = "fit." + s.name + ".";
    summary[prefix + "aicc_difference"] = s.aicc_difference;
    summary[prefix + "cv_behind"] = s.behind;
    summary[prefix + "cv_behind_error"] = s.behind_error;
    summary[prefix + "cv_heights"] = s.level_score;
    summary[prefix + "supported"] = s.supported ? "yes" : "no";
  }
  summary["verdict.best_model"] = fits.selection.ranking.front().name;
  summary["verdict.distinguishable"] = fits.selection.distinguishable ? "yes" : "no";
}

std::string fits_csv(const HeapFits& fits) {
  std::string out = "model,parameter,unit,value,error,bootstrap_error,low,high,at_bound\n";
  for (const Fit& f : fits.fits) {
    for (const FittedParameter& p : f.parameters) {
      out += fmt::format("{},{},{},{},{},{},{},{},{}\n", f.name, p.parameter.name, p.parameter.unit,
                         number(p.value), number(p.error), number(p.bootstrap_error), number(p.low),
                         number(p.high), p.at_bound ? 1 : 0);
    }
  }
  return out;
}

std::string fits_markdown(const HeapFits& fits) {
  return fmt::format("{}\n\n{}.\n\n{}\n{}", fits.selection.sentence, weights_note(fits),
                     markdown_table(kRankingHeader, ranking_rows(fits)),
                     markdown_table(kParameterHeader, parameter_rows(fits)));
}

std::string fits_tex(const HeapFits& fits) {
  return fmt::format("% {}\n{}\n{}", weights_note(fits),
                     tex_table(kRankingHeader, ranking_rows(fits)),
                     tex_table(kParameterHeader, parameter_rows(fits)));
}

std::vector<Section> fit_sections(const HeapFits& fits) {
  std::vector<Section> out;
  std::vector<std::string> best;
  for (const Score& s : fits.selection.ranking) {
    if (best.size() < kDrawn) best.push_back(s.name);
  }
  const FitData& data = fits.heaps.data;
  for (int c = 0; c < static_cast<int>(data.components.size()); ++c) {
    std::vector<Frame> frames;
    for (int level = 0; level < static_cast<int>(data.levels.size()); ++level) {
      Frame frame = frame_of(fits, c, level, best);
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
  if (fits.covariance.kind != "unknown") {
    std::vector<Frame> frames;
    for (int c = 0; c < static_cast<int>(data.components.size()); ++c) {
      Frame frame = residual_frame(fits, best.front(), c);
      if (!frame.series.empty()) frames.push_back(std::move(frame));
    }
    if (!frames.empty()) {
      Picture picture = curves("Where the best model fails: " + best.front(), "x / h (apex at 0)",
                               "(grains - model) / standard error", frames);
      picture.caption = "Beyond 2 or 3 in a row the model is wrong there.";
      out.emplace_back(std::move(picture));
    }
  }
  out.emplace_back(Table{"Ranking",
                         "AICc behind: from the best. CV behind: cross-validation, squared "
                         "difference per effective value on realizations left out, from the best. "
                         "Supported: not behind in both.",
                         kRankingHeader, ranking_rows(fits)});
  out.emplace_back(Table{"Fitted constants",
                         "Errors from the covariance; beside them those of bootstrap draws of the "
                         "piles.",
                         kParameterHeader, parameter_rows(fits)});
  return out;
}

}  // namespace grainfield::coupling
