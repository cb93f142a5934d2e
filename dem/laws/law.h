// What a contact law must have.
//
// A law takes the overlap, the motion at the contact, a coefficient of friction, the time step and
// what the contact remembers, and gives the forces; it advances the memory by the step (dt = 0: by
// nothing). It knows neither grains nor shapes: which measures of the overlap it reads it declares
// (overlap.h: Measures), and a shape that does not offer them is not combined with it.
//
// A law of disks and spheres whose text is over any number (space/number.h; linear.h, hertz.h) is
// one for several contacts side by side, too: in_lanes, and a line in disk_lanes.cc and
// sphere_lanes.cc. Others have kernels of their own: lanes and has_lanes (hertz_elliptic.h,
// engine/batch.h), for polygons area_numbers (area_lanes.h).
#pragma once
#include <concepts>

#include "dem/laws/contact.h"
#include "dem/laws/edge_measure.h"
#include "dem/laws/material_setup.h"

namespace grainfield::dem {

/// What a contact remembers from step to step. All zero: nothing yet.
template <class M, int D>
concept PairMemory = std::default_initializable<M> && requires(const M& memory) {
  { memory.spring } -> std::convertible_to<TangentialOf<D>>;  // of snapshots
  { memory.empty() } -> std::same_as<bool>;
  { memory.reversed() } -> std::same_as<M>;  // seen from the other body
};

template <class L, int D>
concept ContactLaw = PairMemory<typename L::template Memory<D>, D> &&
    requires(const L& law, const OverlapIn<D>& overlap, const ContactMotion<D>& motion,
             typename L::template Memory<D>& memory, double x) {
  { L::name } -> std::convertible_to<const char*>;
  { L::measures } -> std::convertible_to<Measures>;
  { law(overlap, motion, x, x, memory) } -> std::same_as<LawForce<D>>;
  { law.repulsion(overlap) } -> std::same_as<double>;  // normal force without dashpots, N
  { law.energy(overlap, memory) } -> std::same_as<ContactEnergy>;  // elastic, J
};

/// A law for the registry: made of the material's numbers, and what of it bounds the time step
/// (engine.h: stable_time_step). It may tell normal_rate(x, x) of its normal dashpots alone, for
/// the servos of walls, where its viscous_rate is that of others. `edges`: by which measure of a
/// polygon its force grows with the width of a contact.
template <class L>
concept LawEntry = requires(const L& law, double x) {
  { L::name } -> std::convertible_to<const char*>;
  { L::edges } -> std::convertible_to<EdgeMeasure>;
  { L::of(MaterialSetup{}) } -> std::same_as<L>;
  { law.stiffness(x) } -> std::same_as<double>;  // largest, of grains of radius x: N/m
  { law.tangential_stiffness(x) } -> std::same_as<double>;
  { law.viscous_rate(x, x) } -> std::same_as<double>;  // of mass (kg) and radius: 1/s
  { law.edge_stiffness(x) } -> std::same_as<double>;   // of the measure x: N/m
  { law.edge_rate(x, x) } -> std::same_as<double>;     // of mass and measure: 1/s
};

}  // namespace grainfield::dem
