#include "coupling/run/ensemble.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "coupling/run/interrupt.h"
#include "coupling/run/realization_file.h"
#include "dem/study/run.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// CPU time of the calling thread, s: other work on the machine does not count.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string cpu_file(const std::string& file) { return file + ".cpu"; }

// A slice is long enough to cost nothing and short enough to stop at once.
constexpr double kSliceSeconds = 0.05;
// How far a realization is at most until its file is written: only then it counts as done.
constexpr double kAlmost = 0.999;
constexpr auto kReportEvery = std::chrono::milliseconds(200);

// HDF5 is not built for threads: one file at a time.
std::mutex files;

enum class Outcome { finished, stopped };

class Worker {
 public:
  Worker(const std::vector<Task>& tasks, const EnsembleOptions& options)
      : tasks_(tasks),
        options_(options),
        states_(tasks.size()),
        begun_at_(tasks.size(), 0),
        errors_(tasks.size()) {}

  // Takes the tasks of `mine` one after another until none is left or one failed or was stopped.
  void work(const std::vector<std::size_t>& mine, int engine_threads) {
    while (!halt_) {
      const std::size_t at = next_++;
      if (at >= mine.size()) return;
      const std::size_t task = mine[at];
      try {
        if (simulate(task, engine_threads) == Outcome::stopped) stopped_ = halt_ = true;
      } catch (...) {
        errors_[task] = std::current_exception();
        halt_ = true;
      }
    }
  }

  EnsembleProgress progress(const std::vector<std::size_t>& mine, double seconds) {
    EnsembleProgress out;
    out.total = static_cast<int>(mine.size());
    const std::lock_guard lock(mutex_);
    double least = 2, done_now = 0;
    for (const std::size_t task : mine) {
      const auto& state = states_[task];
      out.fraction += state.fraction / out.total;
      done_now += (state.fraction - begun_at_[task]) / out.total;
      if (state.fraction >= 1) {
        ++out.done;
      } else if (!state.phase.empty() && state.fraction < least) {
        least = state.fraction;
        out.phase = state.phase;
        out.simulated_time = state.simulated_time;
        out.grains = state.grains;
        out.awake = state.awake;
        out.kinetic_energy = state.kinetic_energy;
        out.unbalanced_force_ratio = state.unbalanced_force_ratio;
      }
    }
    out.seconds_left = done_now > 0.01 ? seconds * (1 - out.fraction) / done_now : -1;
    return out;
  }

  bool stopped() const { return stopped_; }
  std::exception_ptr first_error() const {
    for (const auto& error : errors_) {
      if (error) return error;
    }
    return nullptr;
  }

 private:
  void note(std::size_t task, const dem::Progress& progress, bool finished = false) {
    const std::lock_guard lock(mutex_);
    if (states_[task].phase.empty()) begun_at_[task] = progress.fraction;
    states_[task] = progress;
    states_[task].fraction = finished ? 1 : std::min(progress.fraction, kAlmost);
  }

  Outcome simulate(std::size_t index, int engine_threads) {
    const Task& task = tasks_[index];
    const std::string checkpoint = task.file + ".checkpoint";
    const auto run = [&] {
      const std::lock_guard lock(files);  // a run may begin by reading a file
      return task.make(engine_threads);
    }();
    double cpu = 0, counted_at = thread_seconds();
    const auto record_cpu = [&] {
      const double now = thread_seconds();
      cpu += engine_threads * (now - counted_at);
      counted_at = now;
      std::ofstream(cpu_file(task.file)) << cpu << '\n';
    };
    const auto save = [&] {
      const std::lock_guard lock(files);
      run->save(checkpoint);
      record_cpu();
    };
    if (fs::exists(checkpoint)) {
      const std::lock_guard lock(files);
      run->restore(checkpoint);
      cpu = cpu_seconds(task.file);
    }
    run->set_watch([&](const dem::Progress& now) {
      note(index, now);
      return !halt_ && !interrupted();
    });
    auto saved = Clock::now();
    long slice = 64;
    while (!run->done()) {
      const dem::Progress now = run->progress();
      note(index, now);
      long steps = slice;
      if (options_.stop_after_steps > 0) {
        steps = std::min(steps, options_.stop_after_steps - now.steps);
      }
      if (halt_ && !stopped_) return Outcome::stopped;  // another realization failed
      if (halt_ || interrupted() || steps <= 0) {
        save();
        return Outcome::stopped;
      }
      if (seconds_since(saved) > options_.checkpoint_seconds) {
        save();
        saved = Clock::now();
      }
      const auto start = Clock::now();
      run->advance(steps);
      const double took = seconds_since(start);
      if (took < kSliceSeconds / 2) slice *= 2;
      if (took > 2 * kSliceSeconds && slice > 1) slice /= 2;
    }
    {
      const std::lock_guard lock(files);
      record_cpu();
      write_realization(task.file, run->result());
    }
    fs::remove(checkpoint);
    note(index, run->progress(), true);
    return Outcome::finished;
  }

  const std::vector<Task>& tasks_;
  const EnsembleOptions& options_;
  std::mutex mutex_;  // states_
  std::vector<dem::Progress> states_;
  std::vector<double> begun_at_;            // fraction that a checkpoint had already
  std::vector<std::exception_ptr> errors_;  // every task writes its own
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> halt_ = false, stopped_ = false;
};

// What became of a rank's tasks, as text that other ranks read: "ok", "stopped", "2 what", "3
// what".
std::string describe(const Worker& worker) {
  const auto error = worker.first_error();
  if (!error) return worker.stopped() ? "stopped" : "ok";
  try {
    std::rethrow_exception(error);
  } catch (const std::invalid_argument& e) {
    return std::string("2") + e.what();
  } catch (const dem::ComputationFailed& e) {
    return std::string("3") + e.what();
  } catch (const std::exception& e) {
    return std::string("1") + e.what();
  }
}

void throw_first(const std::vector<std::string>& outcomes) {
  for (const auto& text : outcomes) {
    if (text == "ok" || text == "stopped") continue;
    const std::string what = text.substr(1);
    if (text[0] == '2') throw std::invalid_argument(what);
    if (text[0] == '3') throw dem::ComputationFailed(what);
    throw std::runtime_error(what);
  }
  if (std::find(outcomes.begin(), outcomes.end(), "stopped") != outcomes.end()) {
    throw Interrupted("stopped");
  }
}

}  // namespace

std::uint64_t realization_seed(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t z = seed + (index + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

std::uint64_t realization_seed(const Case& value, std::int64_t number) {
  return realization_seed(static_cast<std::uint64_t>(value.ensemble.seed),
                          static_cast<std::uint64_t>(number));
}

std::vector<std::uint64_t> realization_seeds(const Case& value) {
  std::vector<std::uint64_t> seeds;
  for (std::int64_t r = 0; r < value.ensemble.realizations; ++r) {
    seeds.push_back(realization_seed(value, r));
  }
  return seeds;
}

void run_tasks(const std::vector<Task>& tasks, const Ranks& ranks, const EnsembleOptions& options) {
  std::vector<std::size_t> mine;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    const bool here = static_cast<int>(t % static_cast<std::size_t>(ranks.size())) == ranks.rank();
    if (here && !fs::exists(tasks[t].file)) mine.push_back(t);
  }
  Worker worker(tasks, options);
  if (!mine.empty()) {
    const int threads = std::max(1, options.threads);
    const int workers = std::min(threads, static_cast<int>(mine.size()));
    std::atomic<int> running = workers;
    std::vector<std::thread> pool;
    pool.reserve(static_cast<std::size_t>(workers));
    for (int w = 0; w < workers; ++w) {
      const int share = threads / workers + (w < threads % workers ? 1 : 0);
      pool.emplace_back([&, share] {
        worker.work(mine, share);
        --running;
      });
    }
    const auto start = Clock::now();
    while (running > 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      static thread_local Clock::time_point reported;
      if (options.progress && Clock::now() - reported > kReportEvery) {
        reported = Clock::now();
        options.progress(worker.progress(mine, seconds_since(start)));
      }
    }
    for (auto& thread : pool) thread.join();
    if (options.progress) options.progress(worker.progress(mine, seconds_since(start)));
  }
  throw_first(ranks.gather(describe(worker)));
}

double cpu_seconds(const std::string& file) {
  double seconds = 0;
  std::ifstream in(cpu_file(file));
  return in >> seconds ? seconds : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace grainfield::coupling
