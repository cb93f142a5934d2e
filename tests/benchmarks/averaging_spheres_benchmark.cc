// Averaging a large synthetic packing of spheres: a million grains with three million contacts onto
// 100,000 points, by kernel width and threads. Run one scene alone under /usr/bin/time -v for its
// memory: --benchmark_filter=lucy_1d/1000000/2
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <numbers>

#include "coupling/averaging/average.h"
#include "dem/random/random.h"

namespace grainfield {
namespace {

// A disturbed cubic lattice in a box as high as wide, each sphere with a contact along every axis,
// those of the lowest layer with the floor. The forces are random: averaging does not care.
const dem::Snapshot& packing(std::int64_t grains) {
  static std::map<std::int64_t, dem::Snapshot> made;
  dem::Snapshot& s = made[grains];
  if (!s.grains.empty()) return s;
  dem::Random random(1);
  const auto n = static_cast<std::int64_t>(std::lround(std::cbrt(static_cast<double>(grains))));
  const double d = 0.01;
  s.dim = 3;
  s.gravity = {0, 0, -9.81};
  dem::Wall floor;
  floor.name = "floor";
  floor.normal = {0, 0, 1};
  s.walls.push_back(floor);
  s.grains.resize(static_cast<std::size_t>(n * n * n));
  for (std::int64_t k = 0; k < n * n * n; ++k) {
    dem::Grain& g = s.grains[static_cast<std::size_t>(k)];
    g.id = k;
    const std::int64_t at[3]{k % n, k / n % n, k / (n * n)};
    for (int a = 0; a < 3; ++a)
      g.position[a] = (static_cast<double>(at[a]) + 0.5 + 0.2 * random.uniform(-1, 1)) * d;
    g.radius = random.uniform(0.4, 0.5) * d;
    g.volume = 4 * std::numbers::pi / 3 * std::pow(g.radius, 3);
    g.mass = 2500 * g.volume;
  }
  s.contacts.reserve(static_cast<std::size_t>(3 * n * n * n));
  const auto touch = [&](std::int64_t i, std::int64_t j) {
    dem::Contact c;
    c.i = i;
    c.j = j;
    const auto& a = s.grains[static_cast<std::size_t>(i)].position;
    dem::Vec3 b = a;
    if (j < 0)
      b.z() = 0;
    else
      b = s.grains[static_cast<std::size_t>(j)].position;
    c.point = j < 0 ? b : dem::Vec3((a + b) / 2);
    c.normal = (b - a).normalized();
    c.force = -random.uniform(0, 2) * c.normal;
    s.contacts.push_back(c);
  };
  for (std::int64_t k = 0; k < n * n * n; ++k) {
    if (k < n * n) touch(k, -1);
    if (k % n + 1 < n) touch(k, k + 1);
    if (k / n % n + 1 < n) touch(k, k + n);
    if (k / (n * n) + 1 < n) touch(k, k + n * n);
  }
  return s;
}

void average(benchmark::State& state, const char* method, const char* kernel, double diameters) {
  const dem::Snapshot& s = packing(state.range(0));
  coupling::AverageOptions options;
  options.method = method;
  options.kernel = kernel;
  options.width = diameters * 0.01;
  options.threads = static_cast<int>(state.range(1));
  const double side = 0.01 * std::cbrt(static_cast<double>(s.grains.size()));
  const Eigen::MatrixXd points =
      coupling::box_points({0, 0, 0}, {side, side, side}, 50, 50, 40);  // 100,000
  for (auto _ : state) benchmark::DoNotOptimize(coupling::average(s, points, options).columns);
  state.counters["contacts"] = static_cast<double>(s.contacts.size());
  state.counters["points"] = static_cast<double>(points.rows());
}

void scenes(benchmark::internal::Benchmark* b) {
  b->Args({125000, 2})->Args({1000000, 1})->Args({1000000, 2});
  b->ArgNames({"", ""})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MeasureProcessCPUTime()
      ->Iterations(1);
}

BENCHMARK_CAPTURE(average, lucy_1d, "coarse_graining", "lucy", 1)->Apply(scenes);
BENCHMARK_CAPTURE(average, lucy_3d, "coarse_graining", "lucy", 3)->Apply(scenes);
BENCHMARK_CAPTURE(average, gaussian_1d, "coarse_graining", "gaussian", 1)->Apply(scenes);
BENCHMARK_CAPTURE(average, particle_centre_3d, "particle_centre", "circle", 3)->Apply(scenes);
BENCHMARK_CAPTURE(average, volume_exact_3d, "area_exact", "circle", 3)->Apply(scenes);

}  // namespace
}  // namespace grainfield
