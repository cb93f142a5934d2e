// A small load on settled spheres by Newton's method: 10,000 spheres, 60,000 unknowns.
#include <benchmark/benchmark.h>

#include "dem/quasistatic/quasistatic.h"
#include "tests/benchmarks/sphere_scene.h"

namespace grainfield::benchmarks {
namespace {

const dem::Snapshot& spheres_at_rest() {
  static const dem::Snapshot rest = [] {
    const dem::Snapshot& settled = sphere_packing();
    return dem::relax(settled, sphere_settings(1), settled.gravity, {}, {}).state;
  }();
  return rest;
}

void small_load_on_spheres(benchmark::State& state) {
  const dem::Snapshot& rest = spheres_at_rest();
  dem::AppliedForce force;
  for (const dem::Grain& g : rest.grains) {
    if (force.id < 0 || g.position.z() > rest.grains[force.id].position.z()) force.id = g.id;
  }
  force.fz = -1e-3;
  int iterations = 0;
  for (auto _ : state) {
    const auto out = dem::relax(rest, sphere_settings(1), rest.gravity, force, {});
    iterations = out.iterations;
    benchmark::DoNotOptimize(out.unbalanced_force_ratio);
  }
  state.counters["unknowns"] = 6.0 * static_cast<double>(rest.grains.size());
  state.counters["newton_iterations"] = iterations;
}
BENCHMARK(small_load_on_spheres)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace grainfield::benchmarks
