// What the support function of a superellipsoid is made of, for one body (superellipsoid.cc) and
// for several side by side (pair_step.cc): powers, and where they end.
#pragma once
#include <array>

namespace grainfield::dem {

// |r_k n_k| counts as at least this share of the greatest of them, so that powers stay finite. Even
// at e = 0.1 it is less than 0.1 % of a semi-axis from the middle of a face.
inline constexpr double kLeastShare = 1e-60;
// On edges, where weights underflow; far below what any law takes for a radius.
inline constexpr double kLeastWeight = 1e-80;
// Powers follow by their series of four terms while the base is within this share of the last one,
// over the power: what is left out is below 1e-14.
inline constexpr double kNear = 1.0 / 256;

/// Powers of the last n of a body that were taken by logarithm and exponential; those of an n near
/// it follow by their series. All 0: none yet.
struct Powers {
  struct OfNorm {
    double inverse_ratio = 0;  ///< greater over lesser component
    double share = 0;          ///< (lesser over greater)^P
    double root = 0;           ///< (1 + share)^(1/P)
  };
  OfNorm level, whole;
};
/// Those of both bodies of a pair.
struct PairPowers {
  Powers i, j;
};

/// Powers of the lesser over the greater component, `ratio`.
Powers::OfNorm powers_at(double ratio, double power);

/// (1 + x)^power by its binomial series, |x| max(power, 1) <= kNear; of a number or of several.
template <class T>
[[gnu::always_inline]] inline T power_near_one(const T& x, const T& power) {
  const T second = (1.0 / 2) * (power - 1) * x, third = (1.0 / 3) * (power - 2) * x;
  const T fourth = (1.0 / 4) * (power - 3) * x;
  return 1 + power * x * (1 + second * (1 + third * (1 + fourth)));
}

}  // namespace grainfield::dem
