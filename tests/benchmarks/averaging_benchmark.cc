// Averaging a large synthetic packing: 100,000 grains with about 250,000 contacts onto 100 x 50
// points, by method, threads and number of grains.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <numbers>

#include "coupling/averaging/average.h"
#include "dem/random/random.h"

namespace grainfield {
namespace {

// A jittered square lattice of disks of random radii (heptagons with `polygons`), as wide as twice
// its height, with a contact to the right, above and, for every second grain, across: 2.5 per
// grain. The forces are random: averaging does not care.
const dem::Snapshot& packing(std::int64_t grains, bool polygons) {
  static std::map<std::pair<std::int64_t, bool>, dem::Snapshot> made;
  dem::Snapshot& s = made[{grains, polygons}];
  if (!s.grains.empty()) return s;
  dem::Random random(1);
  const auto rows = static_cast<std::int64_t>(std::sqrt(static_cast<double>(grains) / 2));
  const std::int64_t columns = grains / rows;
  const double d = 0.01;
  s.gravity = {0, -9.81, 0};
  for (std::int64_t y = 0; y < rows; ++y)
    for (std::int64_t x = 0; x < columns; ++x) {
      dem::Grain g;
      g.id = x + columns * y;
      g.position = {(static_cast<double>(x) + 0.3 * random.uniform(0, 1)) * d,
                    (static_cast<double>(y) + 0.3 * random.uniform(0, 1)) * d, 0};
      g.radius = random.uniform(0.4, 0.5) * d;
      g.volume = std::numbers::pi * g.radius * g.radius;
      g.mass = 5000 * g.volume;
      if (polygons) {
        for (int k = 0; k < 7; ++k)
          g.outline.push_back({g.radius * std::cos(2 * std::numbers::pi * k / 7),
                               g.radius * std::sin(2 * std::numbers::pi * k / 7)});
      }
      s.grains.push_back(g);
    }
  const auto touch = [&](std::int64_t i, std::int64_t j) {
    dem::Contact c;
    c.i = i;
    c.j = j;
    const auto& a = s.grains[static_cast<std::size_t>(i)].position;
    const auto& b = s.grains[static_cast<std::size_t>(j)].position;
    c.point = (a + b) / 2;
    c.normal = (b - a).normalized();
    c.force = -random.uniform(0, 2) * c.normal;
    s.contacts.push_back(c);
  };
  for (std::int64_t y = 0; y < rows; ++y)
    for (std::int64_t x = 0; x < columns; ++x) {
      const std::int64_t i = x + columns * y;
      if (x + 1 < columns) touch(i, i + 1);
      if (y + 1 < rows) touch(i, i + columns);
      if (x + 1 < columns && y + 1 < rows && i % 2 == 0) touch(i, i + columns + 1);
    }
  return s;
}

void average(benchmark::State& state, const char* method, const char* kernel, double diameters,
             bool polygons) {
  const dem::Snapshot& s = packing(state.range(0), polygons);
  coupling::AverageOptions options;
  options.method = method;
  options.kernel = kernel;
  options.width = diameters * 0.01;
  options.threads = static_cast<int>(state.range(1));
  const coupling::LayerFrame frame = coupling::layer_frame(s);
  const Eigen::MatrixXd points =
      coupling::grid_points(frame.left, frame.right, 100, frame.floor, frame.surface, 50);
  for (auto _ : state) benchmark::DoNotOptimize(coupling::average(s, points, options).columns);
  state.counters["contacts"] = static_cast<double>(s.contacts.size());
  state.counters["contacts/s"] = benchmark::Counter(static_cast<double>(s.contacts.size()),
                                                    benchmark::Counter::kIsIterationInvariantRate);
}

void scenes(benchmark::internal::Benchmark* b) {
  b->Args({25000, 2})->Args({100000, 1})->Args({100000, 2})->Args({400000, 2});
  b->ArgNames({"grains", "threads"})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MeasureProcessCPUTime();
}

BENCHMARK_CAPTURE(average, lucy_1d, "coarse_graining", "lucy", 1, false)->Apply(scenes);
BENCHMARK_CAPTURE(average, lucy_5d, "coarse_graining", "lucy", 5, false)->Apply(scenes);
BENCHMARK_CAPTURE(average, gaussian_5d, "coarse_graining", "gaussian", 5, false)->Apply(scenes);
BENCHMARK_CAPTURE(average, particle_centre_5d, "particle_centre", "circle", 5, false)
    ->Apply(scenes);
BENCHMARK_CAPTURE(average, area_exact_disks_5d, "area_exact", "circle", 5, false)->Apply(scenes);
BENCHMARK_CAPTURE(average, area_exact_polygons_5d, "area_exact", "circle", 5, true)->Apply(scenes);

}  // namespace
}  // namespace grainfield
