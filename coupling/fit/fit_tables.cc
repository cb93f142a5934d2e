#include "coupling/fit/fit_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainfield::coupling {
namespace {

std::string tex_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '_' || c == '%') out += '\\';
    out += c;
  }
  const std::size_t at = out.find("+-");
  return at == std::string::npos ? out : out.replace(at, 2, "$\\pm$");
}

}  // namespace

const Fit& fit_named(const std::vector<Fit>& fits, const std::string& name) {
  const auto at =
      std::find_if(fits.begin(), fits.end(), [&](const Fit& f) { return f.name == name; });
  if (at == fits.end()) throw std::logic_error("no fit of " + name);
  return *at;
}

std::string number(double v) { return std::isfinite(v) ? fmt::format("{:.6g}", v) : "nan"; }

std::string with_error(const FittedParameter& p) {
  if (!std::isfinite(p.error)) return fmt::format("{:.3g} (no error)", p.value);
  const int digits =
      std::clamp(1 - static_cast<int>(std::floor(std::log10(std::max(p.error, 1e-12)))), 0, 8);
  return fmt::format("{:.{}f} +- {:.{}f}", p.value, digits, p.error, digits);
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

namespace {

bool by_akaike(const Selection& selection) {
  return std::any_of(selection.ranking.begin(), selection.ranking.end(),
                     [](const Score& s) { return std::isfinite(s.aic_behind); });
}

// Before which column that of chi2 + 2 x free numbers stands.
constexpr std::ptrdiff_t kAkaikeAt = 4;

}  // namespace

std::vector<std::string> ranking_header(const Selection& selection) {
  std::vector<std::string> header{"model",  "free numbers",    "chi2/dof",    "chance to",
                                  "behind", "behind, heights", "relative L2", "supported"};
  if (by_akaike(selection)) header.insert(header.begin() + kAkaikeAt, "chi2 + 2k, behind");
  return header;
}

std::vector<std::vector<std::string>> ranking_rows(const std::vector<Fit>& fits,
                                                   const Selection& selection) {
  const auto difference = [](double value, double error) {
    return std::isfinite(value) ? fmt::format("{:.2g} +- {:.1g}", value, error) : "-";
  };
  std::vector<std::vector<std::string>> rows;
  for (const Score& s : selection.ranking) {
    const Fit& f = fit_named(fits, s.name);
    rows.push_back({s.name, fmt::format("{}", f.parameters.size()),
                    std::isnan(f.chi2_per_dof) ? "-" : fmt::format("{:.3g}", f.chi2_per_dof),
                    std::isnan(f.chance) ? "-" : fmt::format("{:.3g}", f.chance),
                    difference(s.behind, s.behind_error),
                    difference(s.heights_behind, s.heights_error),
                    fmt::format("{:.1f} %", 100 * f.rel_l2), standing(s, f)});
    if (by_akaike(selection)) {
      auto& row = rows.back();
      row.insert(row.begin() + kAkaikeAt, fmt::format("{:.1f}", s.aic_behind));
    }
  }
  return rows;
}

std::string ranking_note(const Selection& selection) {
  std::string note =
      "chi2/dof: squared misfit over what the spread of the realizations makes of a true model's. "
      "Behind: squared difference on realizations left out, from the best model, over the signal's "
      "square, with its paired error; heights: the same on heights left out. Supported: not behind "
      "by more than chance, and chi2/dof within what chance makes of it; where it is not, the "
      "model is nearest of those asked and no more.";
  if (by_akaike(selection)) {
    note += fmt::format(
        " chi2 + 2k: with k free numbers, less the best's; more than {:g} counts, and a model that "
        "is not so far behind is not excluded.",
        kNoSupport);
  }
  return note;
}

const std::string& constants_note() {
  static const std::string note =
      "+-: by leaving one realization out at a time (jackknife), of which intervals are Student's "
      "t of realizations - 1 times it (of ratios of moduli: of their logarithm). Beside it the "
      "errors by the values' covariance, by bootstrap "
      "draws of the realizations, and the 95 % interval by the profile of the misfit.";
  return note;
}

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

std::string parameters_csv(const std::vector<Fit>& fits) {
  std::string out =
      "model,parameter,unit,value,error,low,high,covariance_error,bootstrap_error,jackknife_error,"
      "profile_low,profile_high,at_bound\n";
  for (const Fit& f : fits) {
    for (const FittedParameter& p : f.parameters) {
      out += fmt::format("{},{},{}", f.name, p.parameter.name, p.parameter.unit);
      for (const double v : {p.value, p.error, p.low, p.high, p.covariance_error, p.bootstrap_error,
                             p.jackknife_error, p.by_profile.low, p.by_profile.high}) {
        out += fmt::format(",{}", number(v));
      }
      out += fmt::format(",{}\n", p.at_bound ? 1 : 0);
    }
  }
  return out;
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

void add_ranking(Summary& summary, const std::vector<Fit>& fits, const Selection& selection) {
  for (const Score& s : selection.ranking) {
    const std::string prefix = "fit." + s.name + ".";
    summary[prefix + "cv_behind"] = s.behind;
    summary[prefix + "cv_behind_error"] = s.behind_error;
    summary[prefix + "heights_behind"] = s.heights_behind;
    summary[prefix + "heights_behind_error"] = s.heights_error;
    if (std::isfinite(s.aic_behind)) summary[prefix + "aic_behind"] = s.aic_behind;
    summary[prefix + "supported"] = standing(s, fit_named(fits, s.name));
  }
}

}  // namespace grainfield::coupling
