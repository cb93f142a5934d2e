#include "coupling/elastic_constants/symmetry.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/elastic_constants/samples.h"
#include "coupling/statistics/least_squares.h"

namespace grainfield::coupling {
namespace {

// Equations closer to singular than this do not tell the constants apart.
constexpr double largest_condition = 1e6;
// Sums of squares below this share of the data are rounding.
constexpr double rounding = 1e-26;
// Constraints below this share of C11 are rounding.
constexpr double rounding_of_constraint = 1e-10;

// Determinant of a covariance below this share of its trace's square is rounding.
constexpr double kSingular = 1e-12;

using Equations = Eigen::Matrix<double, 3, 4>;

// Of one sample, in units that make their sum of squares the squared norm of the tensors. Unknowns
// C11, C22, C12, C66.
Equations orthotropic(const Eigen::Vector3d& e) {
  Equations a = Equations::Zero();
  a(0, 0) = e[0];
  a(0, 2) = e[1];
  a(1, 1) = e[1];
  a(1, 2) = e[0];
  a(2, 3) = 2 * std::numbers::sqrt2 * e[2];
  return a;
}

Eigen::Vector3d right_side(const Eigen::Vector3d& s) {
  return {s[0], s[1], std::numbers::sqrt2 * s[2]};
}

// C of K and G: the isotropic constants as orthotropic ones.
Eigen::Matrix<double, 4, 2> isotropic_columns() {
  Eigen::Matrix<double, 4, 2> c;
  c << 1, 1, 1, 1, 1, -1, 0, 1;
  return c;
}

struct System {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right, weights;
};

System system_of(const std::vector<Sample>& samples) {
  const auto n = static_cast<Eigen::Index>(samples.size());
  System s{Eigen::MatrixXd(3 * n, 4), Eigen::VectorXd(3 * n), Eigen::VectorXd(3 * n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const Sample& sample = samples[static_cast<std::size_t>(k)];
    s.matrix.middleRows<3>(3 * k) = orthotropic(sample.strain);
    s.right.segment<3>(3 * k) = right_side(sample.stress);
    s.weights.segment<3>(3 * k).setConstant(sample.weight);
  }
  return s;
}

// Normal equations of one realization, for the draws.
struct NormalSums {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  void add(const Sample& sample) {
    const Equations a = orthotropic(sample.strain);
    matrix += sample.weight * a.transpose() * a;
    right += sample.weight * a.transpose() * right_side(sample.stress);
  }
};

// What the bootstrap follows: C11, C22, C12, C66, both ratios, both constraints, K, G.
constexpr Eigen::Index figures = 10;
Eigen::VectorXd figures_of(const Eigen::Vector4d& c, const Eigen::Vector2d& isotropic) {
  Eigen::VectorXd all(figures);
  const double shear = (c[0] + c[1] - 2 * c[2]) / 4;
  all << c, c[0] / c[1], c[3] / shear, c[0] - c[1], c[3] - shear, isotropic;
  return all;
}

Eigen::VectorXd solve(const NormalSums& sums) {
  const Eigen::Matrix<double, 4, 2> to = isotropic_columns();
  const Eigen::Matrix2d small = to.transpose() * sums.matrix * to;
  Eigen::Vector2d isotropic = Eigen::Vector2d::Constant(kNan);
  if (small.determinant() > 0) isotropic = small.inverse() * (to.transpose() * sums.right);
  const Eigen::LDLT<Eigen::Matrix4d> factors(sums.matrix);
  Eigen::Vector4d c = Eigen::Vector4d::Constant(kNan);
  if (factors.info() == Eigen::Success && factors.rcond() > std::pow(largest_condition, -2))
    c = factors.solve(sums.right);
  return figures_of(c, isotropic);
}

// Chance of constraints this far from zero, given their draws over n realizations.
double hotelling(const Eigen::Vector2d& constraints, const Eigen::MatrixXd& draws, int n,
                 double scale) {
  if (n < 4) return kNan;
  if (constraints.cwiseAbs().maxCoeff() < rounding_of_constraint * scale) return 1;
  Eigen::MatrixXd centred(draws.rows(), 2);
  Eigen::Index rows = 0;
  for (Eigen::Index b = 0; b < draws.rows(); ++b)
    if (draws.row(b).allFinite()) centred.row(rows++) = draws.row(b);
  if (rows < draws.rows() / 2) return kNan;
  centred.conservativeResize(rows, 2);
  centred.rowwise() -= Eigen::RowVector2d(centred.colwise().mean());
  // The spread over draws has divisor n, that of a sample n - 1.
  const Eigen::Matrix2d covariance =
      centred.transpose() * centred / static_cast<double>(rows - 1) * n / (n - 1.0);
  // Copies of one packing, or constraints that move together: no test.
  const double size = covariance.trace() / 2;
  if (!(size > std::pow(rounding_of_constraint * scale, 2))) return kNan;
  if (!(covariance.determinant() > kSingular * size * size)) return kNan;
  const double t2 = constraints.dot(covariance.inverse() * constraints);
  return boost::math::cdf(
      boost::math::complement(boost::math::fisher_f(2, n - 2), t2 * (n - 2) / (2 * (n - 1.0))));
}

double aicc(double squares, double equations, int constants) {
  const double k = constants + 1;  // and the variance
  return equations * std::log(squares / equations) + 2 * k + 2 * k * (k + 1) / (equations - k - 1);
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
  Samples samples;
  for (const Samples& one : all) samples.insert(samples.end(), one.begin(), one.end());

  SymmetryFit fit;
  fit.samples = static_cast<int>(samples.size());
  if (samples.empty()) {
    fit.note = "no point with both stress and strain: no constants";
    return fit;
  }
  const System system = system_of(samples);
  const LeastSquares isotropic =
      least_squares(system.matrix * isotropic_columns(), system.right, system.weights);
  const LeastSquares four = least_squares(system.matrix, system.right, system.weights);
  fit.condition = four.condition;
  const bool two_known = isotropic.condition < 1e9, four_known = four.condition < largest_condition;
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
  std::vector<NormalSums> sums(all.size());
  for (std::size_t r = 0; r < all.size(); ++r)
    for (const Sample& sample : all[r]) sums[r].add(sample);
  const Eigen::VectorXd value =
      figures_of(four_known ? Eigen::Vector4d(four.solution)
                            : Eigen::Vector4d(Eigen::Vector4d::Constant(kNan)),
                 two_known ? Eigen::Vector2d(isotropic.solution)
                           : Eigen::Vector2d(Eigen::Vector2d::Constant(kNan)));
  const auto statistic = [&](const std::vector<int>& chosen) {
    if (chosen == everyone) return value;
    NormalSums drawn;
    for (const int r : chosen) {
      drawn.matrix += sums[static_cast<std::size_t>(r)].matrix;
      drawn.right += sums[static_cast<std::size_t>(r)].right;
    }
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
  const double r2 = std::max(isotropic.residual, rounding * isotropic.data),
               r4 = std::max(four.residual, rounding * four.data);
  if (n > 6) {
    fit.f = std::max(0.0, (r2 - r4) / 2 / (r4 / (n - 4)));
    fit.p_samples =
        boost::math::cdf(boost::math::complement(boost::math::fisher_f(2, n - 4), fit.f));
    fit.aicc_isotropic = aicc(r2, n, 2);
    fit.aicc_orthotropic = aicc(r4, n, 4);
  }
  fit.p_realizations =
      hotelling(value.segment<2>(6), draws.middleCols(6, 2), realizations, std::abs(value[0]));
  return fit;
}

}  // namespace grainfield::coupling
