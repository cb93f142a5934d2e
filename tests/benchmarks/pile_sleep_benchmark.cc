// What sleeping saves while a pile of a point source is poured:
//   pile_sleep_benchmark CASE.toml FOLDER [rounds [realization]]
// Times how long the pile takes for the next grains, with sleeping and with every grain awake, from
// the same states on the way to the full pile, and integrates both over the pour. FOLDER holds the
// states: checkpoints of the realization, 0 (of a run of the case under way, copied), or none: then
// the pile is poured first, with sleeping, and they are left there.
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/run/ensemble.h"
#include "coupling/studies/pile/poured_run.h"
#include "coupling/studies/pile/simulation.h"

namespace {

using grainfield::coupling::Case;
using grainfield::dem::PileRun;

constexpr double kShares[] = {0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95};
// Grains poured in a window. With every grain awake all steps cost the same, so few will do; with
// sleeping the cost hangs on what a grain sets in motion.
constexpr int kAsleepWindow = 30, kAwakeWindow = 3;

PileRun run_of(const Case& value, int realization, const std::string& state) {
  PileRun run(value.get<grainfield::dem::PileSetup>(),
              grainfield::coupling::realization_seed(value, realization), 1);
  if (!state.empty()) run.restore(state);
  return run;
}

void pour_states(const Case& value, int realization, const std::filesystem::path& folder) {
  PileRun run = run_of(value, realization, "");
  for (const double share : kShares) {
    const int grains = static_cast<int>(
        share * static_cast<double>(value.get<grainfield::dem::PileSetup>().source.grains));
    while (run.progress().grains < grains) run.advance(10000);
    run.save(folder / fmt::format("{:06d}.state", grains));
    fmt::print("poured {}\n", grains);
  }
}

// CPU seconds per grain of the next `window` grains.
double seconds_per_grain(const Case& value, int realization, const std::string& state, int window,
                         bool awake) {
  PileRun run = run_of(value, realization, state);
  if (awake) run.keep_awake();
  const double steps = value.get<grainfield::dem::PileSetup>().source.interval / run.time_step();
  run.advance(static_cast<long>(steps));  // until the neighbour list has its margin
  const std::clock_t start = std::clock();
  run.advance(static_cast<long>(window * steps));
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / window;
}

void measure(const std::string& case_file, const std::filesystem::path& folder, int rounds,
             int realization) {
  const Case value = grainfield::coupling::read_case(case_file, false, {});
  if (value.study != "pile" || value.get<grainfield::dem::PileSetup>().source.kind != "point" ||
      !value.get<grainfield::dem::PileSetup>().sleep.on) {
    throw std::invalid_argument(case_file + ": a pile from a point source with sleep.on is needed");
  }
  std::filesystem::create_directories(folder);
  if (std::filesystem::is_empty(folder)) pour_states(value, realization, folder);

  struct State {
    int grains = 0;
    std::string file;
  };
  std::vector<State> states;
  const auto all = static_cast<int>(value.get<grainfield::dem::PileSetup>().source.grains);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path();
    const auto progress = run_of(value, realization, file).progress();
    if (progress.grains + kAsleepWindow + 1 > all) {
      throw std::invalid_argument(file + ": too few grains left to pour");
    }
    states.push_back({progress.grains, file});
  }
  std::sort(states.begin(), states.end(),
            [](const State& p, const State& q) { return p.grains < q.grains; });

  fmt::print("grains  CPU s per grain poured: sleeping  all awake  ratio\n");
  // Trapezoids over the grains poured. With every grain awake the cost is in proportion to the
  // grains before the first and after the last state; with sleeping it stays as it is there.
  double asleep_sum = 0, awake_sum = 0, last_asleep = 0, last_awake = 0;
  int last = 0;
  for (const State& state : states) {
    std::vector<double> asleeps, awakes;
    for (int k = 0; k < rounds; ++k) {
      asleeps.push_back(seconds_per_grain(value, realization, state.file, kAsleepWindow, false));
      awakes.push_back(seconds_per_grain(value, realization, state.file, kAwakeWindow, true));
    }
    const double asleep = boost::math::statistics::median(asleeps);
    const double awake = boost::math::statistics::median(awakes);
    fmt::print("{:6d}  {:33.4f}  {:9.4f}  {:5.2f}\n", state.grains, asleep, awake, awake / asleep);
    std::fflush(stdout);
    if (last == 0) last_asleep = asleep;
    asleep_sum += 0.5 * (asleep + last_asleep) * (state.grains - last);
    awake_sum += 0.5 * (awake + last_awake) * (state.grains - last);
    last = state.grains;
    last_asleep = asleep;
    last_awake = awake;
  }
  asleep_sum += last_asleep * (all - last);
  awake_sum += 0.5 * last_awake * (1 + static_cast<double>(all) / last) * (all - last);
  fmt::print("whole pour: sleeping {:.0f} s, all awake {:.0f} s, ratio {:.2f}\n", asleep_sum,
             awake_sum, awake_sum / asleep_sum);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: pile_sleep_benchmark CASE.toml FOLDER [rounds [realization]]\n");
    return 2;
  }
  try {
    measure(argv[1], argv[2], argc > 3 ? std::max(1, std::atoi(argv[3])) : 3,
            argc > 4 ? std::max(0, std::atoi(argv[4])) : 0);
  } catch (const std::exception& e) {
    fmt::print(stderr, "pile_sleep_benchmark: {}\n", e.what());
    return 2;
  }
}
