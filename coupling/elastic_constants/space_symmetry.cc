// Tensors as vectors xx, yy, zz, yz, xz, xy with the shears times sqrt(2), whose norm is the
// tensor's. Unknowns: orthotropic C11 C22 C33 C12 C13 C23 C44 C55 C66; without shears the first
// six. Smaller laws are columns of these.
#include "coupling/elastic_constants/space_symmetry.h"

#include <Eigen/LU>
#include <algorithm>
#include <numeric>

#include "coupling/elastic_constants/nested_fit.h"
#include "coupling/statistics/least_squares.h"

namespace grainfield::coupling {
namespace {

constexpr int kOrthotropic = 9, kTransverse = 5, kNormal = 4;
using SpaceSample = LinearSample<6, kOrthotropic>;
using Six = Eigen::Matrix<double, 6, 1>;

// A shear below this share of the largest strain is rounding.
constexpr double kNoShear = 1e-6;
constexpr double kChance = 0.05;

Six six_of(const Eigen::Matrix3d& m) {
  const double root = std::numbers::sqrt2;
  Six out;
  out << m(0, 0), m(1, 1), m(2, 2), root * 0.5 * (m(1, 2) + m(2, 1)),
      root * 0.5 * (m(0, 2) + m(2, 0)), root * 0.5 * (m(0, 1) + m(1, 0));
  return out;
}

SpaceSample equations_of(const SpaceIncrement& increment) {
  const Six e = six_of(increment.strain);
  SpaceSample out;
  out.right = six_of(increment.stress);
  auto& m = out.matrix;
  m.setZero();
  for (int a = 0; a < 3; ++a) {
    m(a, a) = e[a];
    m(3 + a, 6 + a) = 2 * e[3 + a];
  }
  m(0, 3) = m(2, 5) = e[1];
  m(1, 3) = m(2, 4) = e[0];
  m(0, 4) = m(1, 5) = e[2];
  return out;
}

// C11, C33, C12, C13, C44 as orthotropic constants.
Eigen::Matrix<double, kOrthotropic, kTransverse> transverse_columns() {
  Eigen::Matrix<double, kOrthotropic, kTransverse> c;
  c.setZero();
  c(0, 0) = c(1, 0) = 1;
  c(2, 1) = 1;
  c(3, 2) = 1;
  c(4, 3) = c(5, 3) = 1;
  c(6, 4) = c(7, 4) = 1;
  c(8, 0) = 0.5;
  c(8, 2) = -0.5;
  return c;
}

// K and G as transversely isotropic constants.
Eigen::Matrix<double, kTransverse, 2> isotropic_in_transverse() {
  Eigen::Matrix<double, kTransverse, 2> c;
  c << 1, 4.0 / 3, 1, 4.0 / 3, 1, -2.0 / 3, 1, -2.0 / 3, 0, 1;
  return c;
}

bool has_shear(const SpaceIncrements& all, int component) {
  double shear = 0, most = 0;
  for (const SpaceIncrement& one : all) {
    const Six e = six_of(one.strain);
    shear = std::max(shear, std::fabs(e[component]));
    most = std::max(most, e.cwiseAbs().maxCoeff());
  }
  return shear > kNoShear * most;
}

bool has_vertical_shear(const SpaceIncrements& all) {
  return has_shear(all, 3) || has_shear(all, 4);
}

bool has_all_shears(const SpaceIncrements& all) {
  return has_shear(all, 3) && has_shear(all, 4) && has_shear(all, 5);
}

// The samples of the first `Constants` transversely isotropic constants.
template <int Constants>
std::vector<LinearSample<6, Constants>> transverse_samples(const SpaceIncrements& all) {
  std::vector<LinearSample<6, Constants>> out;
  for (const SpaceIncrement& one : all) {
    const SpaceSample sample = equations_of(one);
    auto& part = out.emplace_back();
    part.right = sample.right;
    part.matrix = sample.matrix * transverse_columns().leftCols<Constants>();
  }
  return out;
}

std::vector<SpaceSample> orthotropic_samples(const SpaceIncrements& all) {
  std::vector<SpaceSample> out;
  for (const SpaceIncrement& one : all) out.push_back(equations_of(one));
  return out;
}

void put_engineering(const Eigen::VectorXd& c, SpaceModuli& out) {
  Eigen::Matrix3d block;
  block << c[0], c[2], c[3], c[2], c[0], c[3], c[3], c[3], c[1];
  const Eigen::Matrix3d s = block.inverse();
  out.e_h = 1 / s(0, 0);
  out.e_v = 1 / s(2, 2);
  out.nu_h = -s(0, 1) / s(0, 0);
  out.nu_vh = -s(0, 2) / s(2, 2);
  if (c.size() == kTransverse) out.g_vh = c[4];
}

template <int Constants>
SpaceModuli moduli_of(const SpaceIncrements& all) {
  const LinearSystem system = system_of(transverse_samples<Constants>(all));
  const LeastSquares two = least_squares(
      system.matrix * isotropic_in_transverse().topRows<Constants>(), system.right, system.weights);
  const LeastSquares larger = least_squares(system.matrix, system.right, system.weights);
  SpaceModuli out;
  if (two.condition < kLargestCondition) {
    out.bulk = two.solution(0);
    out.shear = two.solution(1);
    out.young = 9 * out.bulk * out.shear / (3 * out.bulk + out.shear);
    out.poisson = out.young / (2 * out.shear) - 1;
    out.residual_isotropic = std::sqrt(two.residual / two.data);
  }
  if (larger.condition < kLargestCondition) {
    put_engineering(larger.solution, out);
    out.residual_transverse = std::sqrt(larger.residual / larger.data);
  }
  return out;
}

// Tests constraints * constants = 0, the smaller law being columns * its constants.
template <int Rows, int Constants, int Fewer>
SymmetryTest test_of(const std::vector<std::vector<LinearSample<Rows, Constants>>>& realizations,
                     const Eigen::Matrix<double, Constants, Constants - Fewer>& columns,
                     const Eigen::Matrix<double, Fewer, Constants>& constraints,
                     const BootstrapOptions& options) {
  std::vector<LinearSample<Rows, Constants>> samples;
  std::vector<NormalSums<Constants>> sums;
  for (const auto& one : realizations) {
    auto& sum = sums.emplace_back();
    for (const auto& sample : one) sum.add(sample);
    samples.insert(samples.end(), one.begin(), one.end());
  }
  const LinearSystem system = system_of(samples);
  const LeastSquares smaller = least_squares(system.matrix * columns, system.right, system.weights);
  const LeastSquares larger = least_squares(system.matrix, system.right, system.weights);
  SymmetryTest out;
  if (!(larger.condition < kLargestCondition)) return out;
  const auto n = static_cast<double>(system.right.size());
  const double floor = kRoundingOfSquares * larger.data;
  if (n > Constants + 2) {
    out.p_samples = nested_test(std::max(smaller.residual, floor), std::max(larger.residual, floor),
                                n, Fewer, Constants)
                        .p;
  }
  const int count = static_cast<int>(realizations.size());
  const auto statistic = [&](const std::vector<int>& chosen) {
    NormalSums<Constants> drawn;
    for (const int r : chosen) drawn.add(sums[static_cast<std::size_t>(r)]);
    return Eigen::VectorXd(constraints * drawn.solve());
  };
  const Eigen::Matrix<double, Constants, 1> value = larger.solution;
  out.p_realizations = hotelling<Fewer>(
      constraints * value, bootstrap_draws(count, statistic, options), count, std::fabs(value[0]));
  return out;
}

template <int Constants>
SymmetryTest isotropy_test(const std::vector<SpaceIncrements>& realizations,
                           const BootstrapOptions& options) {
  constexpr int kFewer = Constants - 2;
  // C11 = C33, C12 = C13, C44 = (C11 - C12)/2.
  Eigen::Matrix<double, 3, kTransverse> all;
  all << 1, -1, 0, 0, 0, 0, 0, 1, -1, 0, -0.5, 0, 0.5, 0, 1;
  std::vector<std::vector<LinearSample<6, Constants>>> samples;
  for (const SpaceIncrements& one : realizations) {
    samples.push_back(transverse_samples<Constants>(one));
  }
  return test_of<6, Constants, kFewer>(samples, isotropic_in_transverse().topRows<Constants>(),
                                       all.topLeftCorner<kFewer, Constants>(), options);
}

SymmetryTest transverse_test(const std::vector<SpaceIncrements>& realizations,
                             const BootstrapOptions& options) {
  // C11 = C22, C13 = C23, C44 = C55, C66 = (C11 + C22 - 2 C12)/4.
  Eigen::Matrix<double, 4, kOrthotropic> constraints;
  constraints << 1, -1, 0, 0, 0, 0, 0, 0, 0,  //
      0, 0, 0, 0, 1, -1, 0, 0, 0,             //
      0, 0, 0, 0, 0, 0, 1, -1, 0,             //
      -0.25, -0.25, 0, 0.5, 0, 0, 0, 0, 1;
  std::vector<std::vector<SpaceSample>> samples;
  for (const SpaceIncrements& one : realizations) samples.push_back(orthotropic_samples(one));
  return test_of<6, kOrthotropic, 4>(samples, transverse_columns(), constraints, options);
}

}  // namespace

SpaceIncrement increment_of(const Eigen::Matrix3d& gradient, const Eigen::Matrix3d& before,
                            const Eigen::Matrix3d& after) {
  const Eigen::Matrix3d spin = 0.5 * (gradient - gradient.transpose());
  const Eigen::Matrix3d turned = spin * before - before * spin;
  return {after - before - turned, 0.5 * (gradient + gradient.transpose())};
}

SpaceModuli space_moduli(const SpaceIncrements& all) {
  return has_vertical_shear(all) ? moduli_of<kTransverse>(all) : moduli_of<kNormal>(all);
}

double SymmetryTest::p() const { return std::isnan(p_realizations) ? p_samples : p_realizations; }

std::string SpaceSymmetry::symmetry() const {
  if (std::isnan(isotropic.p())) return "not known";
  if (isotropic.p() >= kChance && !(transverse.p() < kChance)) return "isotropic";
  if (transverse.p() < kChance) return "less";
  return "transversely isotropic";
}

SpaceSymmetry space_symmetry(const std::vector<SpaceIncrements>& realizations,
                             const ElasticOptions& options) {
  SpaceSymmetry out;
  SpaceIncrements all;
  for (const SpaceIncrements& one : realizations) all.insert(all.end(), one.begin(), one.end());
  if (all.empty()) return out;
  out.isotropic = has_vertical_shear(all)
                      ? isotropy_test<kTransverse>(realizations, options.bootstrap)
                      : isotropy_test<kNormal>(realizations, options.bootstrap);
  if (has_all_shears(all)) out.transverse = transverse_test(realizations, options.bootstrap);
  return out;
}

}  // namespace grainfield::coupling
