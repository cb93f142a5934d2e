// Roul's soft-grain law: repulsion from the overlap area (Roul ch. 2; physics: R = E A / l).
//
//   R = E A / l                          l = r_i r_j / (r_i + r_j)
//   dashpots and spring of friction: area_dashpots.h
#pragma once
#include "dem/laws/area_dashpots.h"
#include "dem/laws/area_lanes.h"
#include "dem/laws/edge_measure.h"
#include "dem/laws/material_setup.h"

namespace grainfield::dem {

struct OverlapAreaLaw : AreaDashpots {
  static constexpr const char* name = "overlap_area";
  static constexpr Measures measures = Measures::area;
  static constexpr EdgeMeasure edges = EdgeMeasure::steepness;
  template <int D>
  using Memory = SpringMemory<D>;

  static OverlapAreaLaw of(const MaterialSetup& m) {
    return {{m.young, m.damping, m.tangential_ratio}};
  }

  /// Stiffness, N/m, that the fastest mode of a chain of grains feels which lie edge on edge, with
  /// chord / l up to `steepness`.
  double edge_stiffness(double steepness) const { return 4 * young * steepness; }
  LawForce<2> operator()(const Overlap& o, const ContactMotion<2>& m, double mu, double dt,
                         SpringMemory<2>& memory) const {
    return forces(repulsion(o), o, m, mu, dt, memory);
  }

  double repulsion(const Overlap& o) const { return young / o.length * o.area; }
  /// For pairs side by side, in a step of dt, s.
  AreaNumbers area_numbers(double mu, double dt) const {
    return {young, damping, tangential_stiffness(), mu, dt};
  }
  /// Work of R for the overlap at constant l, (E/l) * integral of A over the depth. The
  /// integral of the lens area is 2/5 A depth for small overlaps (A ~ depth^{3/2}), to O(depth/r).
  /// For polygons it is a measure between a corner's 1/3 and the 1/2 of edge on edge.
  ContactEnergy energy(const Overlap& o, const SpringMemory<2>& memory) const {
    return {0.4 * young * o.area / o.length * o.depth,
            spring_energy(memory.spring, tangential_stiffness())};
  }
};

}  // namespace grainfield::dem
