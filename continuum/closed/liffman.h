// Piles whose weight runs down along two families of straight lines at +-60 degrees from the
// horizontal: the contact lines of close-packed equal disks (Liffman, Chan and Hughes 1992).
//
// Every line carries half the weight of the grains on it, so what leaves it at the bottom is its
// length times chi g / sqrt 3, chi = m / d the mass per length of a line of disks of diameter d.
// At a point from which the lines up to the left and up to the right are l1 and l2 long, a grain
// presses on the ground with
//   N = chi g (l1 + l2) / 2         down                           (Liffman 52)
//   H = chi g (l1 - l2) / (2 sqrt 3)  to the right                 (Liffman 53)
// The same lines give the stress inside: two uniaxial compressions along them,
//   sigma_yy = -N/d,  sigma_xy = H/d,  sigma_xx = sigma_yy / 3
// which satisfy div sigma = (0, rho g) with rho g = 2 chi g / (sqrt 3 d) exactly.
#pragma once
#include <vector>

namespace grainfield::continuum {

/// What a grain of the lowest row exerts on the ground, N.
struct BaseForce {
  double normal = 0;      ///< down
  double horizontal = 0;  ///< to the right
};

/// A heap with its apex at (0, 0) and its base on y = -height(). Each flank rises with `alpha` from
/// the corner up to the distance `bend` from it, and with `top_alpha` from there to the apex
/// (Liffman fig. 18, "tent"); with top_alpha = alpha a triangle. Angles in rad, above 0 and up to
/// pi/3; bend at most width/2.
struct HeapProfile {
  double alpha = 0, top_alpha = 0;
  double width = 0;  ///< of the base, m
  double bend = 0;   ///< m

  double height() const;
  /// Height of the surface above x, m; at most 0.
  double surface(double x) const;
};

/// Lengths of the two lines from a point up to the surface, m.
struct LineLengths {
  double left = 0, right = 0;  ///< l1: up to the left, l2: up to the right
};
/// For a point inside the heap or on its outline (Liffman 49-51 for the base of a triangle). At a
/// slope of exactly pi/3 the lines along a flank count as inside: the limit from within.
LineLengths line_lengths(const HeapProfile& heap, double x, double y);

/// N and H of Liffman 52, 53 from the lengths and chi g (N/m).
BaseForce line_force(const LineLengths& lengths, double chi_g);

/// Grain i = 1..layers of the base of an equilateral close-packed pile of disks of this weight (N):
/// N = (k+1) m g/2, H = m g tan(pi/6) (2i - k - 1)/2 (Liffman 42, 44). Throws std::invalid_argument
/// for i outside 1..layers.
BaseForce equilateral_base_force(int layers, int i, double weight);

/// The lowest row of any pile on this lattice whose row j (from the base) has rows[j] grains, each
/// row centred and shorter than the one below: Liffman's recurrence (37), (38) summed along both
/// lattice lines, N = m g (n1 + n2)/2, H = m g tan(theta) (n1 - n2)/2 with n1, n2 the grains on the
/// lines up to the left and to the right, the base grain included. `tan_theta`: half the spacing in
/// a row over the distance of rows, 1/sqrt 3 when close-packed. Throws std::invalid_argument for
/// rows that do not shrink.
std::vector<BaseForce> lattice_base_forces(const std::vector<int>& rows, double weight,
                                           double tan_theta);

}  // namespace grainfield::continuum
