// What an integrator must have.
//
// A step is begin (moves the body, before the forces), then end (takes force and torque at the new
// place; a corrector moves the body once more there: end_moves); start gives a body that has not
// moved yet the acceleration of where it stands. All act on one body and its Memory alone, so that
// bodies may be moved in any order.
#pragma once
#include <concepts>

#include "dem/motion/load.h"

namespace grainfield::dem {

template <class I, int D>
concept Integrator = requires(const I& integrator, Body<D>& body, typename I::Memory& memory,
                              const Inertia<D>& inertia, const Load<D>& load) {
  requires std::constructible_from<I, double>;  // time step, s
  { I::end_moves } -> std::convertible_to<bool>;
  { memory.rotation } -> std::convertible_to<RotationOf<D>>;
  integrator.start(body, memory, inertia, load);
  integrator.begin(body, memory, inertia);
  integrator.end(body, memory, inertia, load);
};

/// A kind of integrator for the registry: its word; its limits of the time step (engine.h:
/// stable_time_step): largest dt times decay rate of a dashpot, and largest c dt + k dt^2/2 of a
/// chain of grains edge on edge; whether irregular polygons may go above the latter; whether it
/// leaps, so that forces see velocities of the half step (what the energy balance and local damping
/// go by); whether it moves round grains, too; and the integrator in D dimensions, In<D>.
template <class K>
concept IntegratorEntry = requires {
  { K::name } -> std::convertible_to<const char*>;
  { K::viscous_limit } -> std::convertible_to<double>;
  { K::edge_limit } -> std::convertible_to<double>;
  { K::bears_irregular_edges } -> std::convertible_to<bool>;
  { K::leaps } -> std::convertible_to<bool>;
  { K::moves_round } -> std::convertible_to<bool>;
};

/// The kind integrates motion in D dimensions.
template <class K, int D>
concept IntegratesIn = Integrator<typename K::template In<D>, D>;

/// The kind moves grains of a store: of its dimension, and round ones where it is for these.
template <class K, class Store>
concept Moves = IntegratesIn<K, Store::dim> &&(K::moves_round || !Store::central);

}  // namespace grainfield::dem
