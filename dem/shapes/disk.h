// Contact geometry of disks: with each other and with a half plane.
//
// Two disks of radii r_i, r_j at distance d overlap in a lens. Its chord joins the crossings of the
// outlines; the contact point is the chord's middle, on the line of centres at arm_i from centre i
// (Roul ch. 2: contact point s, characteristic length l = r_i r_j / (r_i + r_j) with r_i, r_j the
// arms). The lens is two circular segments; a segment of half chord h has the area
// r^2 S(h/r), S(x) = asin x - x sqrt(1 - x^2). dA/dd = -chord.
#pragma once
#include <cmath>
#include <numbers>

#include "dem/space/elementary.h"
#include "dem/space/round_overlap.h"

namespace grainfield::dem {

/// S(x) = asin x - x sqrt(1 - x^2), 0 <= x <= 1. Below 0.2 by its series, where the difference
/// would cancel; the first term left out is below 1e-14 of the sum there.
inline double segment_function(double x) {
  const double q = x * x;
  if (x < 0.2) {
    return x * q *
           (2.0 / 3 +
            q * (1.0 / 5 +
                 q * (3.0 / 28 +
                      q * (5.0 / 72 + q * (35.0 / 704 +
                                           q * (63.0 / 1664 + q * (231.0 / 7680 +
                                                                   q * (429.0 / 17408 +
                                                                        q * 6435.0 / 311296))))))));
  }
  return arc_sine(x < 1 ? x : 1.0) - x * std::sqrt(q < 1 ? 1 - q : 0.0);
}

/// Area of the part of a disk beyond a chord whose signed distance from the centre is `arm`
/// (arm < 0: more than half the disk), half chord `half`.
inline double segment_area(double radius, double arm, double half) {
  const double s = segment_function(half / radius);
  return radius * radius * (arm >= 0 ? s : std::numbers::pi - s);
}

/// Fills `overlap` for two disks whose centres are (dx, dy) apart (from the first to the second).
/// Returns false when they do not touch.
template <bool with_area>
inline bool overlap_of_disks(double dx, double dy, double ri, double rj, Overlap& overlap) {
  if (disks_apart(dx, dy, ri, rj)) return false;
  [[maybe_unused]] const DisksMeet<double> meet = disks_meet(dx, dy, ri, rj, overlap);
  if constexpr (with_area) {
    if (meet.inside) {
      const double small = ri < rj ? ri : rj;
      overlap.area = std::numbers::pi * small * small;
      overlap.chord = 0;
      overlap.length = 0.25 * small;
      return true;
    }
    const double half = std::sqrt(meet.sag_i * (ri + overlap.arm_i));
    overlap.chord = 2 * half;
    overlap.area = segment_area(ri, overlap.arm_i, half) + segment_area(rj, overlap.arm_j, half);
    // An arm of a deep overlap can be negative; the length stays positive and bounded below.
    const double ai = std::fmax(overlap.arm_i, 0.25 * ri), aj = std::fmax(overlap.arm_j, 0.25 * rj);
    overlap.length = ai * aj / (ai + aj);
  }
  return true;
}

/// The same for a disk whose centre is at signed distance `height` above a half plane with the
/// outward unit normal (wx, wy). The plane's own arm is infinite, so l = arm_i.
template <bool with_area>
inline bool overlap_with_plane(double height, double radius, double wx, double wy,
                               Overlap& overlap) {
  if (height >= radius) return false;
  overlap.nx = -wx;
  overlap.ny = -wy;
  overlap.depth = radius - height;
  overlap.arm_i = height;
  overlap.arm_j = 0;
  if constexpr (with_area) {
    const double half = height > -radius ? std::sqrt(overlap.depth * (radius + height)) : 0.0;
    overlap.chord = 2 * half;
    overlap.area =
        height > -radius ? segment_area(radius, height, half) : std::numbers::pi * radius * radius;
    overlap.length = std::fmax(height, 0.25 * radius);
  }
  return true;
}

}  // namespace grainfield::dem
