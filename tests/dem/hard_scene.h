// Hard grains for tests: gases in boxes, balls above a floor.
#pragma once
#include <numbers>

#include "dem/checkpoint/checkpoint.h"
#include "dem/collisions/hard_engine.h"
#include "dem/random/random.h"

namespace grainfield::dem::testing {

template <int D>
Body<D> round_grain(double radius, double mass = 1) {
  Body<D> out;
  out.radius = radius;
  out.inverse_mass = 1 / mass;
  out.inverse_inertia = 1 / round_inertia<D>(mass, radius);
  return out;
}

/// side^D grains of radius 1/2 and mass 1 on a square lattice in a cube of that fraction; of
/// `spread` > 0 of radii 1/2 - spread to 1/2, with masses by volume.
template <int D>
std::vector<Body<D>> gas_of(int side, double fraction, Random& random, HardBox<D>& box,
                            double spread = 0) {
  const double volume = D == 2 ? std::numbers::pi / 4 : std::numbers::pi / 6;
  const double spacing = std::pow(volume / fraction, 1.0 / D);
  box.size.setConstant(side * spacing);
  std::vector<Body<D>> out;
  const int count = D == 2 ? side * side : side * side * side;
  for (int k = 0; k < count; ++k) {
    const double radius = 0.5 - spread * random.uniform();
    Body<D> g = round_grain<D>(radius, std::pow(2 * radius, D));
    for (int a = 0, rest = k; a < D; ++a, rest /= side) {
      g.position[a] = (rest % side + 0.5) * spacing;
      g.velocity[a] = random.uniform(-1, 1);
    }
    out.push_back(g);
  }
  return out;
}

/// Goes on until there have been so many collisions of pairs.
template <int D>
void collide_pairs(HardEngine<D>& engine, long pairs) {
  while (engine.tally().pairs < pairs && engine.advance(1000) == 1000) {
  }
}

template <int D>
std::vector<Body<D>> bodies_of(const HardEngine<D>& engine) {
  std::vector<Body<D>> out;
  for (std::size_t k = 0; k < engine.grains(); ++k) out.push_back(engine.body(k));
  return out;
}

/// Least distance of two grains over that at which they touch.
template <int D>
double nearest(const HardBox<D>& box, const std::vector<Body<D>>& grains) {
  double out = kNever;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double way = nearest_way(box, grains[i].position, grains[j].position).norm();
      out = std::min(out, way / (grains[i].radius + grains[j].radius));
    }
  }
  return out;
}

/// (1 + fraction^2/8)/(1 - fraction)^2.
inline double henderson(double fraction) {
  return (1 + fraction * fraction / 8) / ((1 - fraction) * (1 - fraction));
}
inline double carnahan_starling(double eta) {
  return (1 + eta + eta * eta - eta * eta * eta) / std::pow(1 - eta, 3);
}

}  // namespace grainfield::dem::testing
