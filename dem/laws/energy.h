// Soft grains whose repulsion is the gradient of an energy of the overlap area A (Feng, Han and
// Owen 2012): moved round any closed path without damping and friction it does no work.
//
//   R = U'(A) c                          c = |b|, the chord: dA = -c n.du exactly (polygon.h)
//   square: U = E A^2 / (2 l0^2)                                  U' = E A / l0^2
//   power:  U = (3/5) E A^{5/3} / (12^{1/3} l0^{4/3})              U' = E A^{2/3} / (12^{1/3}
//   l0^{4/3})
//           below A_c = share l0^2 a straight line through 0:      U' = U'(A_c) A / A_c
//   dashpots and spring of friction: Roul's, with l0 for l (area_dashpots.h)
//
// l0 = R_i R_j/(R_i + R_j) of the circles of equal area. Where the chord is about l0 both are
// Roul's E A/l; the power is it for disks, to O(overlap/R). An overlap without a chord (one grain
// inside the other) has no force: dA = 0.
#pragma once
#include "dem/laws/area_dashpots.h"
#include "dem/laws/edge_measure.h"
#include "dem/laws/material_setup.h"
#include "dem/space/elementary.h"

namespace grainfield::dem {

struct EnergyLaw : AreaDashpots {
  static constexpr const char* name = "energy";
  static constexpr Measures measures = Measures::gradient;
  static constexpr EdgeMeasure edges = EdgeMeasure::width;
  template <int D>
  using Memory = SpringMemory<D>;
  bool power = false;          ///< the member: power, else square
  double linear_share = 1e-3;  ///< A_c / l0^2, -; of the power

  static EnergyLaw of(const MaterialSetup& m) {
    return {{m.young, m.damping, m.tangential_ratio}, m.energy == "power", m.linear_share};
  }

  /// U'/E at a = A/l0^2, -.
  double slope(double a) const {
    if (!power) return a;
    if (a < linear_share) return power_slope(linear_share) / linear_share * a;
    return power_slope(a);
  }
  /// U / (E l0^2) at a, -.
  double stored(double a) const {
    if (!power) return 0.5 * a * a;
    const double limit = linear_share, at_limit = power_slope(limit);
    if (a < limit) return 0.5 * at_limit / limit * a * a;
    return 0.5 * at_limit * limit + 0.6 * (power_slope(a) * a - at_limit * limit);
  }

  /// Two edges face to face: dA = c dx, so the stiffness is U'' c^2, four times that for the
  /// fastest mode of a chain. `width`: c/l0.
  double edge_stiffness(double width) const {
    const double curvature = power ? power_slope(linear_share) / linear_share : 1;
    return 4 * young * curvature * width * width;
  }
  LawForce<2> operator()(const Overlap& o, const ContactMotion<2>& m, double mu, double dt,
                         SpringMemory<2>& memory) const {
    return forces(repulsion(o), o, m, mu, dt, memory);
  }

  double repulsion(const Overlap& o) const {
    return young * slope(o.area / (o.length * o.length)) * o.chord;
  }
  /// U(A) and the spring's.
  ContactEnergy energy(const Overlap& o, const SpringMemory<2>& memory) const {
    return {young * stored(o.area / (o.length * o.length)) * o.length * o.length,
            spring_energy(memory.spring, tangential_stiffness())};
  }

 private:
  /// a^{2/3} / 12^{1/3}
  static double power_slope(double a) {
    constexpr double kRoot = 2.2894284851066637;
    const double root = cube_root(a);
    return root * root / kRoot;
  }
};

}  // namespace grainfield::dem
