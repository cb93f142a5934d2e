// Hard grains from collision to collision: collisions of pairs per second of one core, after the
// lattice of the start is gone. Cost of a collision against number of grains: log N, and caches.
#include <benchmark/benchmark.h>

#include "dem/collisions/gas.h"
#include "dem/collisions/hard_engine.h"

namespace {

using namespace grainfield::dem;

template <int D>
void collide(HardEngine<D>& engine, long pairs) {
  const long wanted = engine.tally().pairs + pairs;
  while (engine.tally().pairs < wanted) engine.advance(wanted - engine.tally().pairs);
}

template <int D>
void gas(benchmark::State& state, double fraction, double gravity) {
  GasSetup setup;
  setup.grains = state.range(0);
  setup.fraction = fraction;
  setup.radius = 0.5;
  Random random(1);
  HardScene<D> scene;
  scene.box = gas_box<D>(setup);
  scene.gravity[D - 1] = -gravity;  // of a box without floor: all grains fall alike
  HardEngine<D> engine(scene, start_gas<D>(setup, random));
  collide(engine, 10 * setup.grains);
  const HardTally before = engine.tally();
  constexpr long kBatch = 100000;
  for (auto _ : state) collide(engine, kBatch);
  const auto pairs = static_cast<double>(engine.tally().pairs - before.pairs);
  state.counters["collisions"] = benchmark::Counter(pairs, benchmark::Counter::kIsRate);
  state.counters["crossings_per_collision"] =
      static_cast<double>(engine.tally().crossings - before.crossings) / pairs;
  state.counters["void_per_collision"] =
      static_cast<double>(engine.tally().repeated - before.repeated) / pairs;
}

void disks_02(benchmark::State& s) { gas<2>(s, 0.2, 0); }
void disks_035(benchmark::State& s) { gas<2>(s, 0.35, 0); }
void disks_05(benchmark::State& s) { gas<2>(s, 0.5, 0); }
void disks_065(benchmark::State& s) { gas<2>(s, 0.65, 0); }
void falling_disks_035(benchmark::State& s) { gas<2>(s, 0.35, 1e-3); }
void spheres_03(benchmark::State& s) { gas<3>(s, 0.3, 0); }

BENCHMARK(disks_02)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(disks_035)->RangeMultiplier(10)->Range(1000, 100000)->Unit(benchmark::kMillisecond);
BENCHMARK(disks_05)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(disks_065)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(falling_disks_035)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(spheres_03)->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace
