// Time against unknowns of the finite-element layer in 2D: the same layer on ever finer uniform
// meshes, one adaptive cycle on top. Run by hand; docs/benchmarks.md names it.
#include <benchmark/benchmark.h>

#include "continuum/model.h"

namespace {

using namespace grainfield::continuum;

/// state.range(0): cells over the depth; state.range(1): degree.
void fe_layer(benchmark::State& state) {
  std::map<std::string, double> figures;
  for (auto _ : state) {
    const auto model = make_model("fe_elastic_layer", {{"cells", std::to_string(state.range(0))},
                                                       {"degree", std::to_string(state.range(1))},
                                                       {"half_width", "4"},
                                                       {"tolerance", "1"},
                                                       {"refinements", "1"}});
    benchmark::DoNotOptimize(model->stress((Points(1, 2) << 0, -1).finished()));
    figures = model->figures();
  }
  state.counters["unknowns"] = figures["unknowns"];
  state.counters["iterations"] = figures["cg_iterations"];
  state.counters["assemble_s"] = figures["assemble_s"];
  state.counters["solve_s"] = figures["solve_s"];
}

}  // namespace

// The last mesh has 4e3 to 1e6 unknowns.
BENCHMARK(fe_layer)
    ->ArgNames({"cells", "degree"})
    ->ArgsProduct({{8, 16, 32, 64, 128}, {2}})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
