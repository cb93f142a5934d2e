// The contact ellipse by a table of what elliptic.h solves for.
//
// The integrals K and D are smooth functions of the ratio B/A of the relative curvatures, singular
// at 0 and below alone. Each octave of the ratio is cut into eight parts, in each of which both are
// polynomials of the eighth degree through Chebyshev's nodes: a part's half width is at most a
// seventeenth of the distance from its middle to 0, so that the terms fall by 34 a degree, to
// 1e-13. k follows from B/A = k^2 B/D. Nothing is remembered from step to step.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "dem/laws/contact_lanes.h"
#include "dem/laws/elliptic.h"
#include "dem/space/rotation.h"

namespace grainfield::dem {

class EllipseTable {
 public:
  static const EllipseTable& get() {
    static const EllipseTable table;
    return table;
  }

  /// As elliptic_contact, to 1e-12 of it; at once for B/A below 2^20, beyond that solved for.
  EllipticContact contact(double lesser, double greater) const {
    const double ratio = greater / lesser;
    return contact_of(lesser, greater, ratio < kMostRatio ? at(ratio) : ellipse_ratio(ratio));
  }

  static constexpr int kOctaves = 20;
  static constexpr double kMostRatio = 1 << kOctaves;
  /// Rows of kEllipseRow numbers.
  const double* coefficients() const { return parts_[0].k.data(); }

 private:
  static constexpr int kParts = 8, kTerms = 9;
  /// Coefficients of t^n, t from -1 to 1 over the part.
  struct Part {
    std::array<double, kTerms> k{}, d{};
  };
  static_assert(sizeof(Part) == kEllipseRow * sizeof(double));

  EllipseTable() {
    for (int octave = 0; octave < kOctaves; ++octave) {
      for (int part = 0; part < kParts; ++part) {
        parts_[octave * kParts + part] =
            fitted(std::ldexp(1 + (part + 0.5) / kParts, octave), std::ldexp(0.5 / kParts, octave));
      }
    }
  }

  static Part fitted(double middle, double half) {
    // Chebyshev's coefficients, then those of the powers by T_{n+1} = 2 t T_n - T_{n-1}.
    Part out;
    std::array<double, kTerms> cosine{}, k{}, d{};
    for (int node = 0; node < kTerms; ++node) {
      cosine[node] = rotation_of(std::numbers::pi * (node + 0.5) / kTerms).cosine;
      const EllipticIntegrals e = ellipse_ratio(middle + half * cosine[node]).integrals;
      k[node] = e.k;
      d[node] = e.d;
    }
    std::array<double, kTerms> term{1}, before{};  // T_n, T_{n-1}
    for (int n = 0; n < kTerms; ++n) {
      double sum_k = 0, sum_d = 0;
      for (int node = 0; node < kTerms; ++node) {
        const double c = rotation_of(n * std::numbers::pi * (node + 0.5) / kTerms).cosine;
        sum_k += c * k[node];
        sum_d += c * d[node];
      }
      const double share = (n == 0 ? 1.0 : 2.0) / kTerms;
      for (int power = 0; power < kTerms; ++power) {
        out.k[power] += share * sum_k * term[power];
        out.d[power] += share * sum_d * term[power];
      }
      std::array<double, kTerms> next{};
      for (int power = 0; power < kTerms; ++power) {
        const double raised = power == 0 ? 0 : term[power - 1];
        next[power] = (n == 0 ? 1 : 2) * raised - before[power];
      }
      before = term;
      term = next;
    }
    return out;
  }

  EllipseRatio at(double ratio) const {
    ratio = std::max(ratio, 1.0);
    // Octave and part are the exponent and the first three bits of the fraction; t is the rest.
    const auto bits = std::bit_cast<std::uint64_t>(ratio);
    const auto part = static_cast<std::size_t>((bits >> 49) - (std::uint64_t{1023} << 3));
    const auto rest = (bits & ((std::uint64_t{1} << 49) - 1)) << 3 | std::uint64_t{1023} << 52;
    const double t = 2 * std::bit_cast<double>(rest) - 3;
    const Part& p = parts_[part];
    EllipseRatio out;
    auto& e = out.integrals;
    e.k = sum(p.k, t);
    e.d = sum(p.d, t);
    e.b = e.k - e.d;
    out.kappa = std::sqrt(ratio * e.d / e.b);
    return out;
  }
  static double sum(const std::array<double, kTerms>& c, double t) {
    const double t2 = t * t, t4 = t2 * t2;
    return (c[0] + c[1] * t + (c[2] + c[3] * t) * t2) +
           t4 * ((c[4] + c[5] * t + (c[6] + c[7] * t) * t2) + t4 * c[8]);
  }

  std::array<Part, kOctaves * kParts> parts_;
};

}  // namespace grainfield::dem
