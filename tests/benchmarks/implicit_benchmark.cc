// Implicit motion of soft disks: time a step, iterations of Newton's method, and how far energy
// drifts over 100,000 steps at ten times the explicit one.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "dem/grains/lattice_pile.h"
#include "dem/implicit/soft_disks.h"
#include "dem/random/random.h"

namespace {

using namespace grainfield::dem;

Body<2> disk(double x, double y, double radius, double mass) {
  Body<2> out;
  out.position = {x, y};
  out.radius = radius;
  out.inverse_mass = 1 / mass;
  out.inverse_inertia = 2 / (mass * radius * radius);
  return out;
}

void report(benchmark::State& state, const SoftDisks& disks, double before) {
  const ImplicitTally& t = disks.tally();
  state.counters["iterations"] = static_cast<double>(t.iterations) / static_cast<double>(t.solves);
  state.counters["halved"] = static_cast<double>(t.halved);
  if (before != 0) state.counters["drift"] = disks.energy().total() / before - 1;
}

// Disks in a smooth box under gravity, without any loss.
void gas(benchmark::State& state) {
  const int across = static_cast<int>(state.range(0));
  const double side = 1.33 * across, stiffness = 1e4;
  SoftScene scene;
  scene.grains.stiffness = stiffness;
  scene.gravity = {0.1, -0.3};
  scene.walls = {{{0, 0}, {0, 1}, scene.grains},
                 {{0, side}, {0, -1}, scene.grains},
                 {{0, 0}, {1, 0}, scene.grains},
                 {{side, 0}, {-1, 0}, scene.grains}};
  Random random(3);
  std::vector<Body<2>> start;
  for (int k = 0; k < across * across; ++k) {
    const double radius = random.uniform(0.3, 0.5);
    start.push_back(disk((k % across + 0.5) * side / across, (k / across + 0.5) * side / across,
                         radius, 4 * radius * radius));
    start.back().velocity = {random.uniform(-1, 1), random.uniform(-1, 1)};
  }
  ImplicitSettings settings;
  settings.time_step = std::numbers::pi * std::sqrt(1 / stiffness);
  SoftDisks disks(scene, start, settings);
  const double before = disks.energy().total();
  for ([[maybe_unused]] auto _ : state) disks.step(1);
  report(state, disks, before);
}
BENCHMARK(gas)->Arg(3)->Iterations(100000)->Unit(benchmark::kMicrosecond);
BENCHMARK(gas)->Arg(10)->Iterations(10000)->Unit(benchmark::kMicrosecond);

// A frictionless pile of Liffman's softness swings on its weight, without any loss; the ground's
// springs hold its base.
void pile(benchmark::State& state) {
  LatticeSetup lattice;
  lattice.base_grains = static_cast<int>(state.range(0));
  lattice.radius = 0.5;
  const double stiffness = 1e4;
  SoftScene scene;
  scene.grains.stiffness = stiffness;
  scene.gravity = {0, -1};
  SoftLaw floor = scene.grains;
  floor.friction = SoftFriction::coulomb;
  floor.coulomb = 10;
  floor.tangential_stiffness = 2.0 / 7 * stiffness;
  scene.walls = {{{0, 0}, {0, 1}, floor}};
  std::vector<Body<2>> start;
  for (const NewGrain& g : lattice_pile_grains(lattice, 1)) {
    start.push_back(disk(g.x, g.y, g.radius, 1));
    if (!g.rotates) start.back().inverse_inertia = 0;
  }
  ImplicitSettings settings;
  settings.time_step = std::numbers::pi * std::sqrt(1 / stiffness);
  SoftDisks disks(scene, start, settings);
  for ([[maybe_unused]] auto _ : state) disks.step(1);
  report(state, disks, 0);
}
BENCHMARK(pile)->Arg(12)->Iterations(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(pile)->Arg(45)->Iterations(100)->Unit(benchmark::kMicrosecond);

}  // namespace
