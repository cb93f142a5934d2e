#include "coupling/elastic_constants/slab_moduli.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "coupling/elastic_constants/nested_fit.h"
#include "coupling/statistics/least_squares.h"

namespace grainfield::coupling {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// C11, C33, C13, C44 of the plane.
SlabConstants plane_constants(const SpaceIncrements& all) {
  const double root = std::numbers::sqrt2;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(all.size()), 4);
  Eigen::VectorXd right(matrix.rows());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Eigen::Matrix3d &e = all[k].strain, &s = all[k].stress;
    const auto row = 3 * static_cast<Eigen::Index>(k);
    matrix.row(row) << e(0, 0), 0, e(1, 1), 0;
    matrix.row(row + 1) << 0, e(1, 1), e(0, 0), 0;
    matrix.row(row + 2) << 0, 0, 0, root * (e(0, 1) + e(1, 0));
    right.segment<3>(row) << s(0, 0), s(1, 1), root * 0.5 * (s(0, 1) + s(1, 0));
  }
  // K and G: C11 = C33 = K + G, C13 = K - G, C44 = G.
  Eigen::Matrix<double, 4, 2> isotropic;
  isotropic << 1, 1, 1, 1, 1, -1, 0, 1;
  const LeastSquares four = least_squares(matrix, right);
  const LeastSquares two = least_squares(matrix * isotropic, right);
  SlabConstants out;
  out.values.fill(kUnknown);
  if (four.condition < kLargestCondition && two.condition < kLargestCondition) {
    const Eigen::VectorXd c = four.solution;
    Eigen::Matrix2d stiffness;
    stiffness << c[0], c[2], c[2], c[1];
    const Eigen::Matrix2d b = stiffness.inverse();  // without strain across, with nu_h = 0
    const double along_up = b(1, 1) + b(0, 1) * b(0, 1) / b(0, 0);
    out.values[SlabConstants::e_h] = 1 / b(0, 0);
    out.values[SlabConstants::e_v] = 1 / along_up;
    out.values[SlabConstants::nu_h] = 0;
    out.values[SlabConstants::nu_v] = -b(0, 1) / along_up;
    out.values[SlabConstants::g_v] = c[3];
    const double bulk = two.solution(0), shear = two.solution(1);
    out.values[SlabConstants::young] = 3 * shear - shear * shear / bulk;
    out.values[SlabConstants::poisson] = 0.5 * (1 - shear / bulk);
    out.residual_transverse = std::sqrt(four.residual / four.data);
    out.residual_isotropic = std::sqrt(two.residual / two.data);
  }
  return out;
}

SlabConstants space_constants(const SpaceIncrements& all) {
  const SpaceModuli m = space_moduli(all);
  SlabConstants out;
  out.values = {m.e_h, m.e_v, m.nu_h, m.nu_vh, m.g_vh, m.young, m.poisson};
  out.residual_transverse = m.residual_transverse;
  out.residual_isotropic = m.residual_isotropic;
  return out;
}

// Mean and standard error of the mean.
SlabModuli mean_of_slabs(const std::vector<SlabConstants>& all) {
  if (all.empty()) throw std::invalid_argument("slab moduli: found no slab, allowed: one or more");
  SlabModuli out;
  const auto n = static_cast<double>(all.size());
  for (const SlabConstants& one : all) {
    for (std::size_t k = 0; k < one.values.size(); ++k) out.mean[k] += one.values[k] / n;
    out.residual_transverse += one.residual_transverse / n;
    out.residual_isotropic += one.residual_isotropic / n;
  }
  for (std::size_t k = 0; k < out.mean.size(); ++k) {
    double squares = 0;
    for (const SlabConstants& one : all) squares += std::pow(one.values[k] - out.mean[k], 2);
    out.error[k] = all.size() > 1 ? std::sqrt(squares / (n * (n - 1))) : kUnknown;
  }
  return out;
}

}  // namespace

continuum::TransverseModuli SlabConstants::transverse() const {
  return {values[e_h], values[e_v], values[nu_h], values[nu_v], values[g_v]};
}

continuum::TransverseModuli SlabConstants::isotropic() const {
  const double e = values[young], nu = values[poisson];
  return {e, e, nu, nu, e / (2 * (1 + nu))};
}

SlabConstants slab_constants(const SpaceIncrements& increments, int dim) {
  SlabConstants out = dim == 2 ? plane_constants(increments) : space_constants(increments);
  for (const double value : out.values) {
    if (std::isfinite(value)) continue;
    throw std::invalid_argument(
        "slab moduli: the strains do not tell the constants, needed: all directions");
  }
  return out;
}

SpaceIncrements increments_of(const dem::StateProbes& probes) {
  SpaceIncrements out;
  for (const dem::Probe& probe : probes.probes) {
    const auto of = [&](std::size_t way) {
      return increment_of(probe.outcomes[way].gradient, probes.stress, probe.outcomes[way].stress);
    };
    const SpaceIncrement forth = of(0), back = of(1);
    out.push_back({0.5 * (forth.stress - back.stress), 0.5 * (forth.strain - back.strain)});
  }
  return out;
}

SlabModuli slab_of_strips(const SlabConstants& whole, const std::vector<SlabConstants>& strips) {
  SlabModuli out = mean_of_slabs(strips);
  out.mean = whole.values;
  out.residual_transverse = whole.residual_transverse;
  out.residual_isotropic = whole.residual_isotropic;
  return out;
}

SlabModuli slab_of_realizations(const std::vector<SlabConstants>& realizations) {
  return mean_of_slabs(realizations);
}

std::string moduli_table(const std::vector<SlabModuli>& slabs, double depth, bool isotropic) {
  using C = SlabConstants;
  if (slabs.empty())
    throw std::invalid_argument("table of moduli: found no slab, allowed: one or more");
  const std::vector<int> columns = isotropic
                                       ? std::vector<int>{C::young, C::poisson}
                                       : std::vector<int>{C::e_v, C::e_h, C::nu_h, C::nu_v, C::g_v};
  std::string out, errors;
  const auto row = [&](double at, const std::array<double, C::count>& values) {
    std::string text = fmt::format("{:.15g}", at);
    for (const int c : columns) text += fmt::format(",{:.9g}", values[static_cast<std::size_t>(c)]);
    return text + "\n";
  };
  double above = 0;
  for (const SlabModuli& slab : slabs) {
    if (!(slab.depth > above && slab.depth < depth)) {
      throw std::invalid_argument(
          fmt::format("table of moduli: found a slab at {:g} m, allowed: below {:g} m and above "
                      "{:g} m, from the surface downwards",
                      slab.depth, above, depth));
    }
    above = slab.depth;
    errors += "# error at " + row(slab.depth, slab.error);
  }
  out +=
      "# Moduli of horizontal slabs by small strains; the first and the last slab's are those of "
      "surface and base, too.\n";
  out += errors;
  out += isotropic ? "depth,E,nu\n" : "depth,E_v,E_h,nu_h,nu_v,G_v\n";
  out += row(0, slabs.front().mean);
  for (const SlabModuli& slab : slabs) out += row(slab.depth, slab.mean);
  return out + row(depth, slabs.back().mean);
}

}  // namespace grainfield::coupling
