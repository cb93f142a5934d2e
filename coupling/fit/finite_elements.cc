#include "coupling/fit/finite_elements.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "coupling/fit/fit_tables.h"
#include "dem/snapshot/number.h"

namespace grainfield::coupling {

std::string constants_text(const continuum::Settings& settings) {
  std::vector<std::string> out;
  for (const auto& [key, value] : settings) {
    const std::optional<double> number = dem::parse_number(value);
    out.push_back(fmt::format("{}={}", key, number ? fmt::format("{:.4g}", *number) : value));
  }
  return fmt::format("{}", fmt::join(out, ", "));
}

void judge_elements(FiniteElementFit& out, const FitData& data, const Weights& weights,
                    const Fit& fitted, const Eigen::MatrixXd& stresses) {
  const FitModel given{out.name,
                       out.name,
                       {},
                       {Eigen::VectorXd(0)},
                       [&](const Eigen::MatrixXd&, const Eigen::VectorXd&) { return stresses; },
                       ""};
  out.model = predict(data, given, Eigen::VectorXd(0));
  const Eigen::VectorXd mean = data.mean(), off = mean - out.model;
  // The fitted model's spread is this one's, too.
  out.chi2_per_dof =
      fitted.chi2_per_dof * weights.weight.cwiseProduct(off).squaredNorm() / fitted.misfit;
  out.rel_l2 = off.norm() / mean.norm();
  out.from_closed = (out.model - fitted.model).norm() / fitted.model.norm();
}

const std::vector<std::string>& elements_header() {
  static const std::vector<std::string> header{"finite elements", "constants of", "constants",
                                               "chi2/dof",        "relative L2",  "from that fit"};
  return header;
}

std::vector<std::vector<std::string>> element_rows(const std::vector<FiniteElementFit>& elements) {
  std::vector<std::vector<std::string>> rows;
  for (const FiniteElementFit& e : elements) {
    if (!e.why.empty()) {
      rows.push_back({e.name, e.of, e.why, "-", "-", "-"});
      continue;
    }
    rows.push_back({e.name, e.of, e.constants, number(e.chi2_per_dof),
                    fmt::format("{:.1f} %", 100 * e.rel_l2),
                    fmt::format("{:.2g} %", 100 * e.from_closed)});
  }
  return rows;
}

void add_elements(Summary& summary, const std::vector<FiniteElementFit>& elements) {
  for (const FiniteElementFit& e : elements) {
    const std::string prefix = "fe." + e.name + ".";
    summary[prefix + "constants_of"] = e.of;
    summary[prefix + "note"] = e.why;
    if (!e.why.empty()) continue;
    summary[prefix + "chi2_per_dof"] = e.chi2_per_dof;
    summary[prefix + "rel_l2"] = e.rel_l2;
    summary[prefix + "from_closed_form"] = e.from_closed;
  }
}

}  // namespace grainfield::coupling
