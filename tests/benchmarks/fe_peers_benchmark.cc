// The elastic solve that against_fe_peers.sh also gives to CalculiX and dolfinx: time against
// unknowns, iterations and errors.
#include <benchmark/benchmark.h>

#include "continuum/fe/verification.h"

namespace {

using namespace grainfield::continuum;

/// state.range(0): dimension; state.range(1): cells along a side; state.range(2): degree.
void fe_box(benchmark::State& state) {
  const auto argument = [&](int k) { return static_cast<int>(state.range(k)); };
  ManufacturedErrors errors;
  for (auto _ : state) errors = solve_below_load(argument(0), argument(2), argument(1));
  state.counters["unknowns"] = errors.figures["unknowns"];
  state.counters["iterations"] = errors.figures["cg_iterations"];
  state.counters["assemble_s"] = errors.figures["assemble_s"];
  state.counters["solve_s"] = errors.figures["solve_s"];
  state.counters["error"] = errors.displacement;
  state.counters["stress_error"] = errors.stress;
}

}  // namespace

BENCHMARK(fe_box)
    ->ArgNames({"dim", "cells", "degree"})
    ->ArgsProduct({{2}, {32, 64, 128, 256, 512, 700}, {1, 2}})
    ->ArgsProduct({{3}, {8, 10, 16, 20, 34}, {1, 2}})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
