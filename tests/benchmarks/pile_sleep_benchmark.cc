// What sleeping saves while a pile of a point source is poured:
//   pile_sleep_benchmark CASE.toml FOLDER [rounds]
// Times how long the pile takes for the next grains, with sleeping and with every grain awake, from
// the same states on the way to the full pile, and integrates both over the pour. FOLDER holds the
// states: checkpoints of realization 0 (of a run of the case under way, copied), or none: then the
// pile is poured first, with sleeping, and they are left there.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/run/ensemble.h"
#include "dem/study/pile_run.h"

namespace {

using grainfield::coupling::Case;
using grainfield::dem::PileRun;

constexpr double kShares[] = {0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95};
// Grains poured in a window: few awake ones cost as much at every step, sleepers by what falls.
constexpr int kAsleepWindow = 30, kAwakeWindow = 3;

PileRun run_of(const Case& value, const std::string& state) {
  PileRun run(value.pile, grainfield::coupling::realization_seed(value, 0), 1);
  if (!state.empty()) run.restore(state);
  return run;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

void pour_states(const Case& value, const std::filesystem::path& folder) {
  PileRun run = run_of(value, "");
  for (const double share : kShares) {
    const int grains = static_cast<int>(share * static_cast<double>(value.pile.source.grains));
    while (run.progress().grains < grains) run.advance(10000);
    run.save(folder / fmt::format("{:06d}.state", grains));
    fmt::print("poured {}\n", grains);
  }
}

// CPU seconds per grain of the next `window` grains.
double seconds_per_grain(const Case& value, const std::string& state, int window, bool awake) {
  PileRun run = run_of(value, state);
  if (awake) run.keep_awake();
  const double steps = value.pile.source.interval / run.time_step();
  run.advance(static_cast<long>(steps));  // until the neighbour list has its margin
  const std::clock_t start = std::clock();
  run.advance(static_cast<long>(window * steps));
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / window;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: pile_sleep_benchmark CASE.toml FOLDER [rounds]\n");
    return 2;
  }
  const Case value = grainfield::coupling::read_case(argv[1], false, {});
  const std::filesystem::path folder = argv[2];
  const int rounds = argc > 3 ? std::max(1, std::atoi(argv[3])) : 3;
  std::filesystem::create_directories(folder);
  if (std::filesystem::is_empty(folder)) pour_states(value, folder);

  struct State {
    int grains = 0;
    std::string file;
  };
  std::vector<State> states;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path();
    states.push_back({run_of(value, file).progress().grains, file});
  }
  std::sort(states.begin(), states.end(),
            [](const State& p, const State& q) { return p.grains < q.grains; });

  // Trapezoids over the grains poured; nothing at the beginning, the last state's to the end.
  double asleep_sum = 0, awake_sum = 0, last_asleep = 0, last_awake = 0;
  int last = 0;
  const auto add = [&](int grains, double asleep, double awake) {
    asleep_sum += 0.5 * (asleep + last_asleep) * (grains - last);
    awake_sum += 0.5 * (awake + last_awake) * (grains - last);
    last = grains;
    last_asleep = asleep;
    last_awake = awake;
  };
  fmt::print("grains  CPU s per grain poured: sleeping  all awake  ratio\n");
  for (const State& state : states) {
    std::vector<double> asleep, awake;
    for (int k = 0; k < rounds; ++k) {
      asleep.push_back(seconds_per_grain(value, state.file, kAsleepWindow, false));
      awake.push_back(seconds_per_grain(value, state.file, kAwakeWindow, true));
    }
    add(state.grains, median(asleep), median(awake));
    fmt::print("{:6d}  {:33.4f}  {:9.4f}  {:5.2f}\n", state.grains, last_asleep, last_awake,
               last_awake / last_asleep);
    std::fflush(stdout);
  }
  add(static_cast<int>(value.pile.source.grains), last_asleep, last_awake);
  fmt::print("whole pour: sleeping {:.0f} s, all awake {:.0f} s, ratio {:.2f}\n", asleep_sum,
             awake_sum, awake_sum / asleep_sum);
}
