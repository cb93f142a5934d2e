#include "coupling/elastic_constants/symmetry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/elastic_constants/nested_fit.h"
#include "coupling/elastic_constants/samples.h"
#include "coupling/statistics/least_squares.h"

namespace grainfield::coupling {
namespace {

using PlaneSample = LinearSample<3, 4>;

// Unknowns C11, C22, C12, C66; the shear counts twice.
PlaneSample orthotropic(const Sample& sample) {
  const Eigen::Vector3d &e = sample.strain, &s = sample.stress;
  PlaneSample out;
  out.weight = sample.weight;
  out.matrix.setZero();
  out.matrix(0, 0) = e[0];
  out.matrix(0, 2) = e[1];
  out.matrix(1, 1) = e[1];
  out.matrix(1, 2) = e[0];
  out.matrix(2, 3) = 2 * std::numbers::sqrt2 * e[2];
  out.right = {s[0], s[1], std::numbers::sqrt2 * s[2]};
  return out;
}

// C of K and G: the isotropic constants as orthotropic ones.
Eigen::Matrix<double, 4, 2> isotropic_columns() {
  Eigen::Matrix<double, 4, 2> c;
  c << 1, 1, 1, 1, 1, -1, 0, 1;
  return c;
}

// What the bootstrap follows: C11, C22, C12, C66, both ratios, both constraints, K, G.
constexpr Eigen::Index figures = 10;
Eigen::VectorXd figures_of(const Eigen::Vector4d& c, const Eigen::Vector2d& isotropic) {
  Eigen::VectorXd all(figures);
  const double shear = (c[0] + c[1] - 2 * c[2]) / 4;
  all << c, c[0] / c[1], c[3] / shear, c[0] - c[1], c[3] - shear, isotropic;
  return all;
}

Eigen::VectorXd solve(const NormalSums<4>& sums) {
  const Eigen::Matrix<double, 4, 2> to = isotropic_columns();
  const Eigen::Matrix2d small = to.transpose() * sums.matrix * to;
  Eigen::Vector2d isotropic = Eigen::Vector2d::Constant(kNan);
  if (small.determinant() > 0) isotropic = small.inverse() * (to.transpose() * sums.right);
  return figures_of(sums.solve(), isotropic);
}

}  // namespace

bool SymmetryFit::isotropy_holds() const {
  const double p = std::isnan(p_realizations) ? p_samples : p_realizations;
  return p >= 0.05;
}

SymmetryFit fit_symmetry(const Increments& increments, const Locality& where,
                         const ElasticOptions& options) {
  const std::vector<Samples> all = gather(increments, where);
  const int realizations = increments.realizations();
  std::vector<int> everyone;
  for (int r = 0; r < realizations; ++r) everyone.push_back(r);
  std::vector<PlaneSample> samples;
  std::vector<NormalSums<4>> sums(all.size());
  for (std::size_t r = 0; r < all.size(); ++r) {
    for (const Sample& sample : all[r]) {
      samples.push_back(orthotropic(sample));
      sums[r].add(samples.back());
    }
  }

  SymmetryFit fit;
  fit.samples = static_cast<int>(samples.size());
  if (samples.empty()) {
    fit.note = "no point with both stress and strain: no constants";
    return fit;
  }
  const LinearSystem system = system_of(samples);
  const LeastSquares isotropic =
      least_squares(system.matrix * isotropic_columns(), system.right, system.weights);
  const LeastSquares four = least_squares(system.matrix, system.right, system.weights);
  fit.condition = four.condition;
  const bool two_known = isotropic.condition < 1e9, four_known = four.condition < kLargestCondition;
  if (two_known) fit.residual_isotropic = std::sqrt(isotropic.residual / isotropic.data);
  if (!two_known)
    fit.note =
        "no shear or no change of volume: K or G is undefined, see "
        "isotropic_constants; ";
  if (!four_known)
    fit.note += fmt::format(
        "the strains do not tell C11, C22, C12 and C66 apart (condition {:.3g}): isotropy is not "
        "tested",
        four.condition);

  // Draws from the sums of the realizations; the value itself from the orthogonal decomposition.
  const Eigen::VectorXd value =
      figures_of(four_known ? Eigen::Vector4d(four.solution)
                            : Eigen::Vector4d(Eigen::Vector4d::Constant(kNan)),
                 two_known ? Eigen::Vector2d(isotropic.solution)
                           : Eigen::Vector2d(Eigen::Vector2d::Constant(kNan)));
  const auto statistic = [&](const std::vector<int>& chosen) {
    if (chosen == everyone) return value;
    NormalSums<4> drawn;
    for (const int r : chosen) drawn.add(sums[static_cast<std::size_t>(r)]);
    return solve(drawn);
  };
  const Eigen::MatrixXd draws = bootstrap_draws(realizations, statistic, options.bootstrap);
  const auto intervals = bootstrap_intervals(realizations, statistic, draws, options.bootstrap);
  Constant* targets[] = {&fit.c11, &fit.c22,          &fit.c12,
                         &fit.c66, &fit.normal_ratio, &fit.shear_ratio};
  for (std::size_t k = 0; k < 6; ++k) *targets[k] = constant_of(intervals[k]);
  fit.bulk = constant_of(intervals[8]);
  fit.shear = constant_of(intervals[9]);
  if (!four_known || !two_known) return fit;

  fit.residual_orthotropic = std::sqrt(four.residual / four.data);
  const double n = static_cast<double>(system.right.size());
  const double r2 = std::max(isotropic.residual, kRoundingOfSquares * isotropic.data),
               r4 = std::max(four.residual, kRoundingOfSquares * four.data);
  if (n > 6) {
    const NestedTest test = nested_test(r2, r4, n, 2, 4);
    fit.f = test.f;
    fit.p_samples = test.p;
    fit.aicc_isotropic = aicc(r2, n, 2);
    fit.aicc_orthotropic = aicc(r4, n, 4);
  }
  fit.p_realizations =
      hotelling<2>(value.segment<2>(6), draws.middleCols(6, 2), realizations, std::abs(value[0]));
  return fit;
}

}  // namespace grainfield::coupling
