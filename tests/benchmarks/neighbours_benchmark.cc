// The neighbour search alone: mixed sizes, from equal to a ratio of 1:20, and slender grains, whose
// reach is that of their bounding circle. Time per grain must not grow with their number.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "dem/neighbours/hierarchical_grid.h"
#include "dem/random/random.h"

namespace {

using grainfield::dem::HierarchicalGrid;
using grainfield::dem::Random;
using grainfield::dem::Reach;

// Grains of area pi r^2 / aspect with radii between r / ratio and r, equal shares of area per
// octave, anywhere in a square that they fill to 80 %.
std::vector<Reach<2>> scattered(int n, double ratio, double aspect) {
  Random random(1);
  std::vector<Reach<2>> grains(n);
  double area = 0;
  for (Reach<2>& g : grains) {
    // Number density ~ r^-3.
    const double u = random.uniform(), least = 1 / (ratio * ratio);
    g.reach = ratio > 1 ? std::sqrt(least / (1 - u * (1 - least))) : 1;
    area += std::numbers::pi * g.reach * g.reach / aspect;
    g.reach *= 1.05;
  }
  const double width = std::sqrt(area / 0.8);
  for (Reach<2>& g : grains) {
    g.centre.x() = random.uniform(0, width);
    g.centre.y() = random.uniform(0, width);
  }
  return grains;
}

void search(benchmark::State& state, double ratio, double aspect) {
  const auto grains = scattered(static_cast<int>(state.range(0)), ratio, aspect);
  HierarchicalGrid<2> grid;
  std::vector<std::pair<int, int>> pairs;
  for (auto _ : state) {
    grid.build(grains);
    pairs.clear();
    grid.pairs(pairs);
    benchmark::DoNotOptimize(pairs.data());
  }
  const auto n = static_cast<double>(grains.size());
  state.counters["pairs_per_grain"] = static_cast<double>(pairs.size()) / n;
  state.counters["s_per_grain"] =
      benchmark::Counter(n * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
void equal(benchmark::State& s) { search(s, 1, 1); }
void ratio_1_to_5(benchmark::State& s) { search(s, 5, 1); }
void ratio_1_to_20(benchmark::State& s) { search(s, 20, 1); }
void aspect_2(benchmark::State& s) { search(s, 1, 2); }
void aspect_10(benchmark::State& s) { search(s, 1, 10); }

BENCHMARK(equal)->RangeMultiplier(10)->Range(1000, 100000);
BENCHMARK(ratio_1_to_5)->RangeMultiplier(10)->Range(1000, 100000);
BENCHMARK(ratio_1_to_20)->RangeMultiplier(10)->Range(1000, 100000);
BENCHMARK(aspect_2)->RangeMultiplier(10)->Range(1000, 100000);
BENCHMARK(aspect_10)->RangeMultiplier(10)->Range(1000, 100000);

}  // namespace
