// When bodies in free flight meet.
//
// Under one gravity two bodies move relative to each other in a straight line, so that a pair meets
// at the root of a quadratic; a body and a plane likewise. Bodies of different accelerations (one
// lies on the floor) need a quartic.
//
// Round-off. A pair at its distance, or by round-off nearer, that approaches collides at once; one
// that parts never does, whatever the distance says. So round-off leaves overlaps of its own size
// and they do not grow. An approach slower than kNoApproach of the speeds is none: else two bodies
// that go together would collide for ever.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "dem/space/elementary.h"
#include "dem/space/space.h"

namespace grainfield::dem {

inline constexpr double kNever = std::numeric_limits<double>::infinity();
/// Share of the speeds that is round-off.
inline constexpr double kNoApproach = 1e-14;

/// First time t >= 0, s, at which the height h + w t + a t^2/2 comes down to 0; a height below 0
/// counts as 0. kNever: it does not. An infinite height is never left.
inline double fall_time(double h, double w, double a) {
  if (h == kNever) return kNever;
  if (h <= 0 && w < 0) return 0;
  const double square = w * w - 2 * a * h;
  if (w < 0) {
    return square < 0 ? kNever : 2 * h / (std::sqrt(square) - w);  // where a > 0 may turn it round
  }
  if (!(a < 0)) return kNever;
  // Up and down again; what cannot rise out of a height below 0 comes down at its highest.
  return (w + (square > 0 ? std::sqrt(square) : 0)) / -a;
}

/// The two ways apart: r, m, from the first body to the second, and their velocities, m/s.
template <class Vector>
bool approaches(const Vector& r, const Vector& v_first, const Vector& v_second) {
  const double rate = r.dot(v_second - v_first);
  return rate < 0 && rate * rate > kNoApproach * kNoApproach * r.squaredNorm() *
                                       (v_first.squaredNorm() + v_second.squaredNorm());
}

/// First time, s, at which two bodies of one acceleration are `distance` (m) apart and approach.
template <class Vector>
double meet_time(const Vector& r, const Vector& v_first, const Vector& v_second, double distance) {
  const Vector v = v_second - v_first;
  const double rate = r.dot(v);
  if (!(rate < 0)) return kNever;
  const double room = r.squaredNorm() - distance * distance;
  if (room <= 0) return approaches(r, v_first, v_second) ? 0 : kNever;
  const double square = rate * rate - v.squaredNorm() * room;
  if (square < 0) return kNever;
  return room / (std::sqrt(square) - rate);
}

/// A polynomial c[0] + c[1] t + ...
template <std::size_t N>
double polynomial(const std::array<double, N>& c, double t) {
  double sum = c[N - 1];
  for (std::size_t k = N - 1; k > 0; --k) sum = sum * t + c[k - 1];
  return sum;
}

/// Its simple roots in (0, most), ascending, into `roots`; returns how many. Between the roots of
/// its derivative it is monotonic.
template <std::size_t N>
int roots_of(const std::array<double, N>& c, double most, std::array<double, N>& roots) {
  std::array<double, N + 1> ends{};
  int n = 1;
  if constexpr (N > 2) {
    std::array<double, N - 1> slope{}, turns{};
    for (std::size_t k = 0; k + 1 < N; ++k) slope[k] = static_cast<double>(k + 1) * c[k + 1];
    const int found = roots_of(slope, most, turns);
    for (int k = 0; k < found; ++k) ends[n++] = turns[k];
  }
  ends[n] = most;
  int found = 0;
  for (int k = 0; k < n; ++k) {
    double low = ends[k], high = ends[k + 1];
    const double at_low = polynomial(c, low), at_high = polynomial(c, high);
    if (!((at_low < 0 && at_high > 0) || (at_low > 0 && at_high < 0))) continue;
    // Halving ends where nothing lies between: 60 steps for a root not far below `most`.
    while (true) {
      const double middle = 0.5 * (low + high);
      if (!(low < middle && middle < high)) break;
      ((polynomial(c, middle) < 0) == (at_low < 0) ? low : high) = middle;
    }
    roots[found++] = high;
  }
  return found;
}

/// The same of bodies whose accelerations differ by `a`, the second's less the first's, m/s2.
template <class Vector>
double meet_time(const Vector& r, const Vector& v_first, const Vector& v_second, const Vector& a,
                 double distance) {
  if (a.isZero(0)) return meet_time(r, v_first, v_second, distance);
  const Vector v = v_second - v_first;
  const double room = r.squaredNorm() - distance * distance;
  if (room <= 0 && approaches(r, v_first, v_second)) return 0;
  // Nothing but the acceleration brings bodies in touch nearer.
  const double rate = r.dot(v), bend = v.squaredNorm() + r.dot(a);
  if (room <= 0 && rate <= 0 && bend < 0) return 0;
  const std::array<double, 5> square{room > 0 ? room : 0, 2 * rate, bend, v.dot(a),
                                     0.25 * a.squaredNorm()};
  // No root is larger (Fujiwara 1916).
  const auto share = [&](int k) { return std::fabs(square[k] / square[4]); };
  const double most = 2 * std::max({std::sqrt(std::sqrt(share(0))), cube_root(share(1)),
                                    std::sqrt(share(2)), share(3)});
  std::array<double, 5> roots{};
  const std::array<double, 4> slope{square[1], 2 * square[2], 3 * square[3], 4 * square[4]};
  const int found = roots_of(square, 1.001 * most, roots);
  for (int k = 0; k < found; ++k) {
    if (polynomial(slope, roots[k]) < 0) return roots[k];
  }
  return kNever;
}

}  // namespace grainfield::dem
