// Grain-steps per second of the disk engine on settled packings with friction memory.
#include <benchmark/benchmark.h>

#include "tests/benchmarks/packing_scene.h"

namespace {

using grainfield::benchmarks::packing_scene;

std::string data(const char* name) { return std::string(GRAINFIELD_BENCHMARK_DATA) + "/" + name; }

void run(benchmark::State& state, const char* file, double width, int tiles) {
  const auto engine = packing_scene(data(file), width, tiles, static_cast<int>(state.range(0)));
  engine->step(200);
  constexpr long kSteps = 100;
  for (auto _ : state) engine->step(kSteps);
  state.counters["grains"] = engine->grains();
  state.counters["grain_steps"] =
      benchmark::Counter(static_cast<double>(engine->grains()) * kSteps * state.iterations(),
                         benchmark::Counter::kIsRate);
}

void disks_1k(benchmark::State& s) { run(s, "packing_discs_1k.csv", 0.64, 1); }
void disks_10k(benchmark::State& s) { run(s, "packing_discs_10k.csv", 2, 1); }
void disks_30k(benchmark::State& s) { run(s, "packing_discs_10k.csv", 2, 3); }
void disks_100k(benchmark::State& s) { run(s, "packing_discs_10k.csv", 2, 10); }

BENCHMARK(disks_1k)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(disks_10k)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(disks_30k)->Arg(1)->UseRealTime();
BENCHMARK(disks_100k)->Arg(1)->Arg(2)->UseRealTime();

}  // namespace
