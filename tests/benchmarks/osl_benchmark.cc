// Time against unknowns of oriented stress linearity: the heap by finite elements on ever finer
// aligned meshes, and by marching in depth. Run by hand; docs/benchmarks.md keeps the figures.
#include <benchmark/benchmark.h>

#include "continuum/model.h"

namespace {

using namespace grainfield::continuum;

void solve(benchmark::State& state, const Settings& settings) {
  std::map<std::string, double> figures;
  for (auto _ : state) {
    const auto model = make_model("fe_osl_wedge", settings);
    benchmark::DoNotOptimize(model->stress((Points(1, 2) << 0, -1).finished()));
    figures = model->figures();
  }
  state.counters["unknowns"] = figures["unknowns"];
  state.counters["force_balance"] = figures["force_balance"];
  state.counters["microseconds_per_unknown"] = 1e6 * figures["solve_s"] / figures["unknowns"];
}

/// state.range(0): columns on either side and half the rows; state.range(1): order.
void osl_elements(benchmark::State& state) {
  solve(state, {{"columns", std::to_string(state.range(0))},
                {"rows", std::to_string(2 * state.range(0))},
                {"order", std::to_string(state.range(1))}});
}

void osl_march(benchmark::State& state) {
  solve(state, {{"solver", "march"}, {"columns", std::to_string(state.range(0))}});
}

}  // namespace

// 4e3 to 1.2e6 unknowns.
BENCHMARK(osl_elements)
    ->ArgNames({"columns", "order"})
    ->ArgsProduct({{8, 16, 32, 64, 128}, {2}})
    ->Args({91, 3})
    ->Args({256, 1})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK(osl_march)
    ->ArgName("columns")
    ->RangeMultiplier(2)
    ->Range(16, 256)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
