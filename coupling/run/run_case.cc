#include "coupling/run/run_case.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "continuum/fe/elastic.h"
#include "coupling/output/atomic_file.h"
#include "coupling/run/interrupt.h"
#include "coupling/run/studies.h"
#include "coupling/run/study_result.h"
#include "coupling/run/sweep.h"
#include "coupling/version.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string identity(const Case& value) {
  return "# grainfield " + version() + "\n" + grain_keys_text(value);
}

// "friction = 0.3 there, friction = 0.5 here": the first line in which two written cases differ.
std::string first_difference(const std::string& there, const std::string& here) {
  std::istringstream a(there), b(here);
  std::string left, right;
  while (true) {
    const bool more_left = static_cast<bool>(std::getline(a, left));
    const bool more_right = static_cast<bool>(std::getline(b, right));
    if (!more_left || !more_right) return "another number of keys";
    if (left != right) return fmt::format("{} there, {} here", left, right);
  }
}

// The folder of a run with its staging area and checkpoints. Rank 0 makes and removes them.
class Workplace {
 public:
  explicit Workplace(const std::string& folder)
      : folder_(folder), partial_(folder_ / ".partial"), checkpoint_(folder_ / "checkpoint") {}

  void open(const Case& value, bool resume) {
    std::error_code error;
    // The topmost folder that this run makes goes again if nothing comes of it.
    for (fs::path p = fs::absolute(folder_); !fs::exists(p, error); p = p.parent_path()) made_ = p;
    fs::create_directories(folder_, error);
    if (error) throw_unwritable(error.message());
    if (!fs::is_directory(folder_)) throw_unwritable("it is a file");
    if (access(folder_.c_str(), W_OK | X_OK) != 0) throw_unwritable("no write permission");
    if (fs::exists(checkpoint_)) {
      if (!resume) {
        throw std::invalid_argument(fmt::format(
            "{}: holds an unfinished run; continue it with --resume, or remove that folder",
            checkpoint_.string()));
      }
      const std::string there = read_text_file(checkpoint_ / "grains.txt");
      const std::string here = identity(value);
      if (there != here) {
        throw std::invalid_argument(
            fmt::format("{}: is of another case: {}; remove that folder to start over",
                        checkpoint_.string(), first_difference(there, here)));
      }
    }
    fs::remove_all(partial_, error);
    fs::create_directories(partial_, error);
    if (error) throw_unwritable(error.message());
    fs::create_directories(checkpoint_, error);
    if (error) throw_unwritable(error.message());
    write_text_file((checkpoint_ / "case.toml").string(), write_case(value));
    write_text_file((checkpoint_ / "grains.txt").string(), identity(value));
  }

  bool unfinished() const { return fs::exists(checkpoint_); }
  bool finished() const { return fs::exists(folder_ / "summary.json"); }

  // Finished or half-done realizations that --resume could go on from.
  bool holds_work() const noexcept {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(checkpoint_, error)) {
      if (entry.path().extension() == ".h5" || entry.path().extension() == ".checkpoint") {
        return true;
      }
    }
    return false;
  }

  // Moves everything that is complete to its place. An earlier run's results go first, its
  // summary.json before all: a summary never stands beside another run's data.
  void publish() {
    fs::remove(folder_ / "summary.json");
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      const bool ours = name == "report.html" || name == "snapshots.h5" || name == "fields.h5" ||
                        name == "fields.xdmf" || name == "elastic_map.csv" ||
                        name.starts_with("profiles.") || name.starts_with("fits.") ||
                        name.ends_with(".vtu");
      if (ours && entry.is_regular_file()) fs::remove(entry.path());
    }
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(partial_)) {
      if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), partial_));
    }
    const auto last = [](const fs::path& file) { return file.filename() == "summary.json"; };
    std::sort(files.begin(), files.end());
    std::stable_partition(files.begin(), files.end(), [&](const fs::path& f) { return !last(f); });
    for (const auto& file : files) {
      fs::create_directories((folder_ / file).parent_path());
      fs::rename(partial_ / file, folder_ / file);
    }
    fs::remove_all(partial_);
    fs::remove_all(checkpoint_);
  }

  // After an interrupt what --resume needs stays.
  void abandon(bool keep_checkpoint) noexcept {
    std::error_code error;
    fs::remove_all(partial_, error);
    if (keep_checkpoint) return;
    fs::remove_all(checkpoint_, error);
    if (made_.empty()) return;
    for (fs::path p = fs::absolute(folder_);; p = p.parent_path()) {
      if (!fs::is_empty(p, error) || error) return;
      fs::remove(p, error);
      if (p == made_) return;
    }
  }

  std::string partial(const std::string& inner = "") const { return (partial_ / inner).string(); }
  std::string checkpoint(const std::string& inner) const { return (checkpoint_ / inner).string(); }

 private:
  [[noreturn]] void throw_unwritable(const std::string& why) const {
    throw std::invalid_argument(fmt::format("{}: cannot write there: {}", folder_.string(), why));
  }

  fs::path folder_, partial_, checkpoint_, made_;
};

// Work of rank 0 alone whose failure all ranks must learn of.
void on_first_rank(const Ranks& ranks, const std::function<void()>& work) {
  std::exception_ptr error;
  std::string report = "ok";
  if (ranks.first()) {
    try {
      work();
    } catch (const std::exception& e) {
      error = std::current_exception();
      report = e.what();
    }
  }
  const auto reports = ranks.gather(report);
  if (error) std::rethrow_exception(error);
  if (reports.front() != "ok") throw std::invalid_argument(reports.front());
}

std::string member_file(const Workplace& place, const std::string& suffix, std::int64_t index) {
  return place.checkpoint(
      fmt::format("{}realization_{:03}.h5", suffix.empty() ? "" : suffix + "_", index));
}

double simulate(const std::vector<SweepCase>& members, const Workplace& place, const Ranks& ranks,
                const RunOptions& options) {
  std::vector<Task> tasks;
  for (const auto& member : members) {
    const Case& value = member.value;
    const Study& study = study_of(value);
    if (!study.has_grains()) continue;
    for (std::int64_t r = 0; r < value.ensemble.realizations; ++r) {
      tasks.push_back(
          {[&study, &value, r](int threads) { return study.make_run(value, r, threads); },
           member_file(place, member.suffix, r)});
    }
  }
  const auto start = Clock::now();
  if (tasks.empty()) return 0;
  options.note(
      fmt::format("{} realization{} of grains", tasks.size(), tasks.size() == 1 ? "" : "s"));
  EnsembleOptions ensemble;
  ensemble.threads = options.threads;
  ensemble.checkpoint_seconds = options.checkpoint_seconds;
  ensemble.stop_after_steps = options.stop_after_steps;
  ensemble.progress = options.progress;
  ensemble.note = options.note;
  run_tasks(tasks, ranks, ensemble);
  return seconds_since(start);
}

// Of the member's realizations, in their order; none for a study of models alone.
std::vector<std::string> realization_files(const SweepCase& member, const Workplace& place) {
  const Case& value = member.value;
  std::vector<std::string> files;
  for (std::int64_t r = 0; study_of(value).has_grains() && r < value.ensemble.realizations; ++r) {
    files.push_back(member_file(place, member.suffix, r));
  }
  return files;
}

StudyResult analyse(const SweepCase& member, const Workplace& place, int threads) {
  return study_of(member.value).analyse(member.value, realization_files(member, place), threads);
}

// Averages, models and outputs of all members. `times` adds what only the run knows.
void analyse_all(const Case& value, const std::vector<SweepCase>& members, const Workplace& place,
                 const Ranks& ranks, const RunOptions& options,
                 const std::function<void(std::size_t, Summary&)>& times) {
  // Every rank analyses and one writes. Beside grains each rank solves its own finite elements, so
  // that the bits do not depend on the ranks; a study of models alone is solved by all together.
  const bool grains = study_of(value).has_grains();
  continuum::solve_on(grains ? continuum::Ranks::own : continuum::Ranks::all);
  const std::string kept =
      grains ? fmt::format(
                   "; the grains are kept in {}/checkpoint: --resume repeats the analysis "
                   "alone, also with other keys of analysis and output",
                   options.folder)
             : "";
  try {
    std::vector<StudyResult> results;
    for (const auto& member : members) {
      if (interrupted()) throw Interrupted("stopped");
      options.note(fmt::format("models and comparison{}{}", member.suffix.empty() ? "" : " of ",
                               member.suffix));
      results.push_back(analyse(member, place, options.threads));
    }
    options.note("outputs");
    on_first_rank(ranks, [&] {
      for (std::size_t m = 0; m < members.size(); ++m) {
        fs::create_directories(place.partial(members[m].suffix));
        times(m, results[m].summary);
        write_study(place.partial(members[m].suffix), results[m]);
      }
      if (!value.sweep.key.empty()) write_sweep(place.partial(), value, members, results);
    });
  } catch (const Interrupted&) {
    throw;
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(e.what() + kept);
  } catch (const continuum::ComputationFailed& e) {
    throw continuum::ComputationFailed(e.what() + kept);
  } catch (const dem::ComputationFailed& e) {
    throw dem::ComputationFailed(e.what() + kept);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(e.what() + kept);
  }
}

// Of this process so far, MB; Linux counts in units of 1024 bytes.
double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024e-6;
}

void compute(const Case& value, const Workplace& place, const Ranks& ranks,
             const RunOptions& options) {
  const auto start = Clock::now();
  const std::vector<SweepCase> members = sweep_cases(value);
  const double dem_seconds = simulate(members, place, ranks, options);
  analyse_all(value, members, place, ranks, options, [&](std::size_t m, Summary& summary) {
    if (study_of(members[m].value).has_grains()) {
      double cpu = 0;
      for (const auto& file : realization_files(members[m], place)) cpu += cpu_seconds(file);
      summary["time.dem_cpu_s"] = cpu;
      summary["time.dem_s"] = dem_seconds;
    }
    summary["time.total_s"] = seconds_since(start);
    summary["memory.peak_MB"] = peak_memory();
  });
}

}  // namespace

void run_case(const Case& value, const Ranks& ranks, const RunOptions& options) {
  Workplace place(options.folder);
  bool opened = false;
  try {
    on_first_rank(ranks, [&] {
      if (options.resume && !place.unfinished()) {
        if (place.finished()) {
          const std::string again = fmt::format(
              ", or analyse its piles again in another folder: --set "
              "'grains.files=[\"{}/snapshots.h5\"]'",
              options.folder);
          throw std::invalid_argument(fmt::format(
              "--resume: the run in {} is finished; leave --resume out to run anew in its place{}",
              options.folder, value.study.starts_with("pile") ? again : ""));
        }
        options.note(fmt::format("nothing to resume in {}: starting anew", options.folder));
      }
      if (!options.resume && place.finished() && !place.unfinished()) {
        options.note(
            fmt::format("{} holds a finished run; this one will take its place", options.folder));
      }
      place.open(value, options.resume);
    });
    opened = true;
    const InterruptGuard guard;
    compute(value, place, ranks, options);
    on_first_rank(ranks, [&] { place.publish(); });
  } catch (const Interrupted&) {
    ranks.barrier();
    if (ranks.first()) place.abandon(true);
    throw Interrupted(
        fmt::format("stopped; {}/checkpoint holds the state: continue with the same "
                    "command and --resume",
                    options.folder));
  } catch (...) {
    if (ranks.first() && opened) place.abandon(place.holds_work());
    throw;
  }
}

}  // namespace grainfield::coupling
