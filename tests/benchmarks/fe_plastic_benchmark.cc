// The elastic-plastic heap (associated flow, gravity at once, rough base, one load step): time of
// an iteration of Newton's method, with its evaluations, assembly, factorization and solution,
// against the unknowns. Run by hand; docs/benchmarks.md names it.
#include <benchmark/benchmark.h>

#include <string>

#include "continuum/model.h"

namespace {

using namespace grainfield::continuum;

/// state.range(0): triangles along a side.
void fe_plastic(benchmark::State& state) {
  std::map<std::string, double> figures;
  for (auto _ : state) {
    const auto model = make_model(
        "fe_mohr_coulomb_wedge",
        {{"dilation_deg", "28"}, {"iterations", "60"}, {"cells", std::to_string(state.range(0))}});
    benchmark::DoNotOptimize(model->stress((Points(1, 2) << 0, -1).finished()));
    figures = model->figures();
  }
  state.counters["unknowns"] = figures["unknowns"];
  state.counters["iterations"] = figures["newton_iterations"];
  // Processor seconds of the whole solve, mesh and stress included, for one iteration.
  state.counters["per_iteration_s"] = benchmark::Counter(
      figures["newton_iterations"], benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace

BENCHMARK(fe_plastic)
    ->ArgName("cells")
    ->Arg(4)  // loads the library
    ->Arg(24)
    ->Arg(48)
    ->Arg(96)
    ->Arg(144)
    ->Arg(192)
    ->Arg(276)
    ->Iterations(1)
    ->Unit(benchmark::kSecond);
