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
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "coupling/base/signals.h"
#include "coupling/run/realization_file.h"
#include "coupling/run/time_left.h"
#include "dem/cannot_read_now.h"
#include "dem/run/run.h"
#include "dem/shared/number.h"
#include "dem/storage_failed.h"

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

// A slice is short enough to stop soon. Its last step keeps the forces of all contacts, and its
// progress is measured: in a layer of 30,000 spheres, where a step takes 5 ms, both together took
// over a quarter of the time of slices of 0.05 s.
constexpr double kSliceSeconds = 0.5;
// How far a realization is at most until its file is written: only then it counts as done.
constexpr double kAlmost = 0.999;
constexpr auto kReportEvery = std::chrono::milliseconds(200);

// HDF5 is not built for threads: one file at a time.
std::mutex files;

enum class Outcome { finished, stopped };

// "FILE is broken (WHY): ...", where what() begins with the file.
std::string starts_again(const std::string& file, const std::invalid_argument& error) {
  std::string why = error.what();
  if (why.starts_with(file)) why.erase(0, file.size());
  why.erase(0, std::min(why.find_first_not_of(": "), why.size()));
  return fmt::format("{} is broken ({}): this realization starts again", file, why);
}

// Nothing is known of what is in the file: hours of work, perhaps.
dem::CannotReadNow kept_as_it_is(const dem::CannotReadNow& error) {
  return dem::CannotReadNow(
      fmt::format("{}; it is kept as it is: continue with --resume once it can be read, or remove "
                  "it to compute that realization again",
                  error.what()));
}

std::vector<std::size_t> kinds_of(const std::vector<Task>& tasks) {
  std::vector<std::size_t> out;
  for (const Task& task : tasks) out.push_back(task.kind);
  return out;
}

class Worker {
 public:
  Worker(const std::vector<Task>& tasks, const EnsembleOptions& options)
      : tasks_(tasks),
        options_(options),
        states_(tasks.size()),
        left_(kinds_of(tasks)),
        errors_(tasks.size()) {}

  // Takes the tasks of `mine` one after another until none is left or one failed or was stopped.
  void work(const std::vector<std::size_t>& mine, int engine_threads) {
    while (!halt_) {
      const std::size_t at = next_++;
      if (at >= mine.size()) return;
      const std::size_t task = mine[at];
      try {
        if (simulate(task, engine_threads) == Outcome::stopped) stop();
      } catch (...) {
        errors_[task] = std::current_exception();
        halt_ = true;
      }
    }
  }

  // Progress of this rank's tasks, `done_before` of which are none of `mine`.
  EnsembleProgress progress(const std::vector<std::size_t>& mine, std::size_t done_before,
                            int workers) {
    EnsembleProgress out;
    out.total = static_cast<int>(mine.size() + done_before);
    out.done = static_cast<int>(done_before);
    out.fraction = static_cast<double>(out.done) / out.total;
    const std::lock_guard lock(mutex_);
    double least = 2;
    for (const std::size_t task : mine) {
      const auto& state = states_[task];
      out.fraction += state.fraction / out.total;
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
    out.seconds_left = left_.left(mine, workers);
    return out;
  }

  // As a signal does.
  void stop() {
    stopped_ = true;  // first: who sees halt_ alone believes in a failure, and saves nothing
    halt_ = true;
  }
  void add_note(std::string text) {
    const std::lock_guard lock(mutex_);
    notes_.push_back(std::move(text));
  }
  std::vector<std::string> take_notes() {
    const std::lock_guard lock(mutex_);
    return std::exchange(notes_, {});
  }

  bool stopped() const { return stopped_; }
  // What became of the tasks: the first failure, an Interrupted, or null.
  std::exception_ptr outcome() const {
    for (const auto& error : errors_) {
      if (error) return error;
    }
    if (stopped_ || interrupted()) return std::make_exception_ptr(Interrupted("stopped"));
    return nullptr;
  }

 private:
  // False when the checkpoint is broken; it stays until the next one takes its place.
  bool restore(dem::Run& run, const std::string& checkpoint) {
    try {
      const std::lock_guard lock(files);
      run.restore(checkpoint);
      return true;
    } catch (const dem::OtherSetup&) {
      throw;
    } catch (const dem::CannotReadNow& error) {
      throw kept_as_it_is(error);
    } catch (const std::invalid_argument& error) {
      add_note(starts_again(checkpoint, error));
      return false;
    }
  }

  void note(std::size_t task, const dem::Progress& progress, bool finished = false) {
    const std::lock_guard lock(mutex_);
    states_[task] = progress;
    states_[task].fraction = finished ? 1 : std::min(progress.fraction, kAlmost);
    left_.tell(task, seconds_since(begin_), states_[task].fraction);
  }

  Outcome simulate(std::size_t index, int engine_threads) {
    const Task& task = tasks_[index];
    const std::string checkpoint = task.file + ".checkpoint";
    const auto make = [&] {
      const std::lock_guard lock(files);  // a run may begin by reading a file
      return task.make(engine_threads);
    };
    std::unique_ptr<dem::Run> run = make();
    double cpu = 0, counted_at = thread_seconds();
    const auto record_cpu = [&] {
      const double now = thread_seconds();
      cpu += engine_threads * (now - counted_at);
      counted_at = now;
      std::ofstream(cpu_file(task.file)) << fmt::format("{:g}\n", cpu);
    };
    const auto save = [&] {
      const std::lock_guard lock(files);
      run->save(checkpoint);
      record_cpu();
    };
    if (fs::exists(checkpoint)) {
      if (restore(*run, checkpoint)) {
        cpu = cpu_seconds(task.file);
      } else {
        run = make();
      }
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
  const Clock::time_point begin_ = Clock::now();
  std::mutex mutex_;  // states_, left_, notes_
  std::vector<dem::Progress> states_;
  TimeLeft left_;
  std::vector<std::string> notes_;
  std::vector<std::exception_ptr> errors_;  // every task writes its own
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> halt_ = false, stopped_ = false;
};

// Whether the realization is done. A broken file stays until the new one takes its place.
bool finished(const std::string& file, Worker& worker) {
  if (!fs::exists(file)) return false;
  try {
    read_realization(file);
    return true;
  } catch (const dem::CannotReadNow& error) {
    throw kept_as_it_is(error);
  } catch (const std::invalid_argument& error) {
    worker.add_note(starts_again(file, error));
    return false;
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
  Worker worker(tasks, options);
  std::string noted;
  const auto pass_notes = [&] {
    for (const std::string& text : worker.take_notes()) {
      noted += text + '\n';
      if (options.note) options.note(text);
    }
  };
  std::vector<std::size_t> mine;
  std::exception_ptr unreadable;
  std::size_t done_before = 0;
  try {
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      const auto size = static_cast<std::size_t>(ranks.size());
      if (static_cast<int>(t % size) != ranks.rank()) continue;
      if (finished(tasks[t].file, worker)) {
        ++done_before;
      } else {
        mine.push_back(t);
      }
    }
  } catch (...) {
    // The other ranks are told at the end, where they meet this one.
    unreadable = std::current_exception();
    mine.clear();
  }
  pass_notes();
  if (!mine.empty()) {
    const int threads = std::max(1, options.threads);
    const int workers = std::min(threads, static_cast<int>(mine.size()));
    std::atomic<int> running = workers;
    std::vector<std::thread> pool;
    pool.reserve(static_cast<std::size_t>(workers));
    for (int w = 0; w < workers; ++w) {
      const int share = threads / workers + (w < threads % workers ? 1 : 0);
      try {
        pool.emplace_back([&, share] {
          worker.work(mine, share);
          --running;
        });
      } catch (const std::system_error& error) {
        // Those that could be started do all of the work.
        running -= workers - w;
        if (w > 0) break;
        throw std::runtime_error(
            fmt::format("--threads: no thread can be started: {}", error.code().message()));
      }
    }
    bool told = false;
    Clock::time_point reported;
    while (running > 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (ranks.stopped_elsewhere()) worker.stop();
      if (!told && (worker.stopped() || interrupted())) {
        ranks.tell_stop();
        told = true;
      }
      pass_notes();
      if (options.progress && Clock::now() - reported > kReportEvery) {
        reported = Clock::now();
        options.progress(worker.progress(mine, done_before, workers));
      }
    }
    for (auto& thread : pool) thread.join();
    pass_notes();
    if (options.progress) options.progress(worker.progress(mine, done_before, workers));
  }
  const std::vector<std::string> all_notes = ranks.gather(noted);
  for (std::size_t r = 1; ranks.first() && options.note && r < all_notes.size(); ++r) {
    std::istringstream lines(all_notes[r]);
    for (std::string text; std::getline(lines, text);) options.note(text);
  }
  throw_together(ranks, unreadable ? unreadable : worker.outcome());
}

double cpu_seconds(const std::string& file) {
  std::ifstream in(cpu_file(file));
  std::string seconds;
  in >> seconds;
  return parse_number(seconds).value_or(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace grainfield::coupling
