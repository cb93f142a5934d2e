// Whether the inside of a sheared sample contracts before it dilates.
#include <Eigen/Core>
#include <cmath>

#include "coupling/run/study_result.h"
#include "coupling/statistics/bootstrap.h"
#include "coupling/studies/sample/rve.h"
#include "coupling/studies/sample/rve_page.h"

namespace grainfield::coupling {
namespace {

const std::vector<Figure<Contraction::Volume>>& volume_rows() {
  using V = const Contraction::Volume&;
  static const std::vector<Figure<Contraction::Volume>> rows{
      {"rve.contraction", "-",
       "simple shear: -trace/3 of the strain of the largest RVEs where its mean over the samples "
       "is least; the first state does not count, so it is below 0 where they dilate from the "
       "start",
       [](V v) { return -v.there; }},
      {"rve.dilation", "-", "trace/3 of their strain at the end of the loading less the one there",
       [](V v) { return v.at_end - v.there; }},
  };
  return rows;
}

const std::vector<ErrorFigure<Contraction>>& contraction_rows() {
  static const std::vector<ErrorFigure<Contraction>> rows{
      {"rve.contraction_strain", "-",
       "shear strain xz of the samples there, its standard error by drawing samples anew",
       [](const Contraction& c) {
         return ValueWithError{c.strain, std::isfinite(c.strain_error)
                                             ? std::optional(c.strain_error)
                                             : std::nullopt};
       }},
  };
  return rows;
}

// states x realizations, of the loading: trace/3 of the strain of the largest RVEs.
Eigen::MatrixXd volume_paths(const RveTable& table) {
  const auto states = table.loading + 1;
  Eigen::MatrixXd out(states, static_cast<Eigen::Index>(table.gradients.size()));
  for (Eigen::Index k = 0; k < out.cols(); ++k) {
    const RveStates& own = table.values.back()[static_cast<std::size_t>(k)];
    for (Eigen::Index s = 0; s < states; ++s) {
      out(s, k) = mean_over(own[static_cast<std::size_t>(s)], [](const RveValue& v) {
                    return v.hull.trace() / 3;
                  }).mean;
    }
  }
  return out;
}

// Where the mean of these realizations is least; the first state, which is 0, does not count.
Eigen::Index turning(const Eigen::MatrixXd& paths, const std::vector<int>& chosen) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(paths.rows());
  for (const int k : chosen) sum += paths.col(k);
  Eigen::Index at = 0;
  sum.tail(sum.size() - 1).minCoeff(&at);
  return at + 1;
}

double shear_at(const RveTable& table, Eigen::Index state) {
  double sum = 0;
  for (const auto& path : table.gradients) {
    const Eigen::Matrix3d& m = path[static_cast<std::size_t>(state)];
    sum += 0.5 * (m(0, 2) + m(2, 0));
  }
  return sum / static_cast<double>(table.gradients.size());
}

}  // namespace

Contraction rve_contraction(const RveTable& table) {
  Contraction out;
  if (table.radii.empty() || table.loading < 1) return out;
  const Eigen::MatrixXd paths = volume_paths(table);
  const int realizations = static_cast<int>(paths.cols());
  std::vector<int> all;
  for (int k = 0; k < realizations; ++k) all.push_back(k);
  const Eigen::Index at = turning(paths, all);
  for (Eigen::Index k = 0; k < paths.cols(); ++k) {
    out.volumes.push_back({paths(at, k), paths(paths.rows() - 1, k)});
  }
  out.strain = shear_at(table, at);
  if (realizations < 2) return out;
  const auto strain = [&](const std::vector<int>& chosen) {
    return Eigen::VectorXd::Constant(1, shear_at(table, turning(paths, chosen)));
  };
  out.strain_error = bootstrap(realizations, strain, {}).front().error;
  return out;
}

void add_contraction(const Contraction& found, Summary& summary) {
  if (found.volumes.empty()) return;
  FigureSamples samples;
  for (const Contraction::Volume& volume : found.volumes) {
    add_samples(volume_rows(), volume, samples);
  }
  add_figures(summary, samples);
  add_values(contraction_rows(), found, summary);
}

std::vector<SummaryKey> contraction_figures() {
  return joined({declared(volume_rows()), declared(contraction_rows())});
}

}  // namespace grainfield::coupling
