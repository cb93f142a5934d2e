// What is known in closed form of an impact of two round bodies.
//
// A force K d^n + c d^{(n-1)/2} d' of the depth d that never pulls is a linear spring and dashpot
// in x = d^{(n+1)/2} and ds = d^{(n-1)/2} dt (Antypov and Elliott 2011), with the frequency and
// decay
//
//   w0^2 = (n+1) K/(2 m),  b = c/(2 m),
//
// so its restitution depends on b/w0 alone, not on the speed (Schwager and Poeschel 2007).
//
//   linear             n = 1    K = k_n               b/w0 = (gamma_n/2) sqrt(m/k_n)
//   hertz, critical    n = 3/2  K = 4/3 E* sqrt(R)    b/w0 = sqrt(6/5) zeta
//   energy, square     n = 2    K = 16/3 E/R          b/w0 = gamma/2     (disks, small depths)
//   overlap_area       n = 3/2  K = 4/3 sqrt(2/R) E   only without dashpot (disks, small depths)
//
// Across the normal: Walton (1993) has two kinds of impact, with slip throughout or without any.
#pragma once
#include <limits>

#include "coupling/studies/pair/simulation.h"

namespace grainfield::coupling {

/// Closed form of one impact; nan where there is none for these bodies and this law.
struct PairClosedForm {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double restitution_normal = kNone;
  double duration = kNone;   ///< s
  double max_depth = kNone;  ///< m
  double max_force = kNone;  ///< N; without dashpot
  /// Linear law without dashpots and rolling resistance: slip throughout where tan(angle) >= mu
  /// max(k_n/k_t, 2 m/m_t - k_n/k_t), for then the spring of friction is at its limit at every
  /// instant. Else 1 where both springs swing in step (k_n/k_t = m/m_t), and none where they do
  /// not: such a contact sticks and slips in turn.
  double restitution_tangential = kNone;
};

/// At this speed (m/s) and angle (deg). Only for disks and spheres that meet head on, without spin
/// and local damping.
PairClosedForm pair_closed_form(const dem::PairSetup& setup, double speed, double angle_deg);

/// Tangential restitution of round bodies that slip throughout, whatever the law:
/// -1 + mu (1 + e_n) (m/m_t)/tan(angle), m/m_t = 3 of disks, 7/2 of spheres. At an angle of 0: inf;
/// nan unless they meet head on, without spin and rolling resistance.
double restitution_of_slip(const dem::PairSetup& setup, double restitution_normal,
                           double angle_deg);

/// Elastic force at this depth (m), N; nan where there is no closed form.
double pair_elastic_force(const dem::PairSetup& setup, double depth);

}  // namespace grainfield::coupling
