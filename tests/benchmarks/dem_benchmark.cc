// Grain-steps per second on settled packings with friction memory, every grain awake: disks, and
// polygons with seven corners, round and on ellipses twice to ten times as long as wide, and
// spheres.
#include <benchmark/benchmark.h>

#include <map>

#include "tests/benchmarks/heptagon_scene.h"
#include "tests/benchmarks/packing_scene.h"
#include "tests/benchmarks/sphere_scene.h"

namespace {

using grainfield::benchmarks::packing_scene;

std::string data(const char* name) { return std::string(GRAINFIELD_BENCHMARK_DATA) + "/" + name; }

void run(benchmark::State& state, const std::unique_ptr<grainfield::dem::Engine>& engine) {
  engine->step(200);
  constexpr long kSteps = 100;
  for (auto _ : state) engine->step(kSteps);
  state.counters["grains"] = engine->grains();
  state.counters["grain_steps"] =
      benchmark::Counter(static_cast<double>(engine->grains()) * kSteps * state.iterations(),
                         benchmark::Counter::kIsRate);
}

void disks(benchmark::State& s, const char* file, double width, int tiles) {
  run(s, packing_scene(data(file), width, tiles, static_cast<int>(s.range(0))));
}
void disks_1k(benchmark::State& s) { disks(s, "packing_discs_1k.csv", 0.64, 1); }
void disks_10k(benchmark::State& s) { disks(s, "packing_discs_10k.csv", 2, 1); }
void disks_30k(benchmark::State& s) { disks(s, "packing_discs_10k.csv", 2, 3); }
void disks_100k(benchmark::State& s) { disks(s, "packing_discs_10k.csv", 2, 10); }

void heptagons(benchmark::State& s, int columns, int rows, int tiles, double aspect = 1) {
  struct Box {
    grainfield::dem::Snapshot grains;
    double width = 0;
  };
  static std::map<std::pair<int, double>, Box> boxes;  // settling takes longer than measuring
  Box& box = boxes[{columns, aspect}];
  if (box.grains.grains.empty()) {
    box.grains = grainfield::benchmarks::settled_heptagons(columns, rows, box.width, aspect);
  }
  run(s, grainfield::benchmarks::heptagon_scene(box.grains, box.width, tiles,
                                                static_cast<int>(s.range(0)), aspect));
}
void heptagons_500(benchmark::State& s) { heptagons(s, 25, 20, 1); }
void heptagons_5k(benchmark::State& s) { heptagons(s, 100, 50, 1); }
void heptagons_50k(benchmark::State& s) { heptagons(s, 100, 50, 10); }
void slender_1_to_2(benchmark::State& s) { heptagons(s, 40, 25, 5, 2); }
void slender_1_to_5(benchmark::State& s) { heptagons(s, 40, 25, 5, 5); }
void slender_1_to_10(benchmark::State& s) { heptagons(s, 40, 25, 5, 10); }

void spheres_10k(benchmark::State& s) {
  run(s, grainfield::benchmarks::sphere_scene(false, static_cast<int>(s.range(0))));
}
void hertz_spheres_10k(benchmark::State& s) {
  run(s, grainfield::benchmarks::sphere_scene(true, static_cast<int>(s.range(0))));
}

BENCHMARK(disks_1k)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(disks_10k)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(disks_30k)->Arg(1)->UseRealTime();
BENCHMARK(disks_100k)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(heptagons_500)->Arg(1)->UseRealTime();
BENCHMARK(heptagons_5k)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(heptagons_50k)->Arg(1)->UseRealTime();
BENCHMARK(slender_1_to_2)->Arg(1)->UseRealTime();
BENCHMARK(slender_1_to_5)->Arg(1)->UseRealTime();
BENCHMARK(spheres_10k)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(hertz_spheres_10k)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(slender_1_to_10)->Arg(1)->UseRealTime();

}  // namespace
