#include "coupling/fit/fit_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/judge/words.h"
#include "coupling/result/csv.h"
#include "coupling/result/text_table.h"

namespace grainfield::coupling {
const Fit& fit_of(const std::vector<Fit>& fits, const std::string& name) {
  const auto at =
      std::find_if(fits.begin(), fits.end(), [&](const Fit& f) { return f.name == name; });
  if (at == fits.end()) throw std::logic_error("no fit of " + name);
  return *at;
}

std::string number(double v) { return std::isfinite(v) ? fmt::format("{:.6g}", v) : "nan"; }

std::string with_error(const FittedParameter& p) {
  if (!std::isfinite(p.error)) return fmt::format("{:.3g} (no error)", p.value);
  return with_error(p.value, p.error);
}

namespace {

std::string size_of(double error) {
  return std::isfinite(error) ? fmt::format("{:.2g}", error) : "-";
}
std::string shown(const Interval& i) {
  return std::isnan(i.low) ? "-" : fmt::format("{:.3g} to {:.3g}", i.low, i.high);
}

}  // namespace

const std::vector<std::string>& parameter_header() {
  static const std::vector<std::string> header{
      "model",     "parameter", "value", "by the covariance",
      "bootstrap", "profile",   "unit",  "strongest correlation",
      "note"};
  return header;
}

std::vector<std::vector<std::string>> parameter_rows(const std::vector<Fit>& fits) {
  std::vector<std::vector<std::string>> rows;
  for (const Fit& f : fits) {
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
      rows.push_back({f.name, p.parameter.name, with_error(p), size_of(p.covariance_error),
                      size_of(p.bootstrap_error), shown(p.by_profile), p.parameter.unit, with,
                      p.at_bound      ? "at its bound"
                      : !p.determined ? "not determined"
                      : !f.converged  ? "search did not converge"
                                      : ""});
    }
  }
  return rows;
}

std::string constants_text(const std::vector<Fit>& fits) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& row : parameter_rows(fits)) {
    rows.push_back({row[0], row[1], row[2], row[6], row[8]});
  }
  if (rows.empty()) return "";
  return markdown_table({"model", "constant", "value", "unit", "note"}, rows);
}

const std::string& constants_note() {
  static const std::string note =
      "±: by leaving one realization out at a time (jackknife), of which intervals are Student's "
      "t of realizations - 1 times it (of ratios of moduli: of their logarithm). Beside it the "
      "errors by the values' covariance, by bootstrap "
      "draws of the realizations, and the 95 % interval by the profile of the misfit.";
  return note;
}

std::string parameters_csv(const std::vector<Fit>& fits) {
  Csv out;
  out.row("model", "parameter", "unit", "value", "error", "low", "high", "covariance_error",
          "bootstrap_error", "jackknife_error", "profile_low", "profile_high", "at_bound");
  for (const Fit& f : fits) {
    for (const FittedParameter& p : f.parameters) {
      out.add(f.name).add(p.parameter.name).add(p.parameter.unit);
      for (const double v : {p.value, p.error, p.low, p.high, p.covariance_error, p.bootstrap_error,
                             p.jackknife_error, p.by_profile.low, p.by_profile.high}) {
        out.add(std::isfinite(v) ? v : kNan);
      }
      out.row(p.at_bound);
    }
  }
  return out.text();
}

void add_parameters(Summary& summary, const std::vector<Fit>& fits) {
  for (const Fit& f : fits) {
    const std::string prefix = "fit." + f.name + ".";
    for (const FittedParameter& p : f.parameters) {
      summary[prefix + p.parameter.name] = p.value;
      summary[prefix + p.parameter.name + ".error"] = p.error;
      summary[prefix + p.parameter.name + ".covariance_error"] = p.covariance_error;
      summary[prefix + p.parameter.name + ".bootstrap_error"] = p.bootstrap_error;
      summary[prefix + p.parameter.name + ".jackknife_error"] = p.jackknife_error;
    }
    summary[prefix + "chi2_per_dof"] = f.chi2_per_dof;
    summary[prefix + "chi2_chance"] = f.chance;
    summary[prefix + "rel_l2"] = f.rel_l2;
    summary[prefix + "note"] = f.note;
  }
}

void add_ranking(Summary& summary, const Judgement& judgement) {
  for (const JudgedModel& m : judgement.models) {
    const std::string prefix = "fit." + m.name + ".";
    summary[prefix + "cv_behind"] = m.behind;
    summary[prefix + "cv_behind_error"] = m.behind_error;
    summary[prefix + "heights_behind"] = m.heights_behind;
    summary[prefix + "heights_behind_error"] = m.heights_error;
    if (std::isfinite(m.aic_behind)) summary[prefix + "aic_behind"] = m.aic_behind;
    summary[prefix + "distinguishable"] = std::string(m.distinguishable_text());
    summary[prefix + "agrees"] = std::string(text_of(m.agrees()));
    summary[prefix + "supported"] = std::string(text_of(m.supported()));
  }
}

}  // namespace grainfield::coupling
