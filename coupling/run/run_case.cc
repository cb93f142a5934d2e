#include "coupling/run/run_case.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "continuum/fe_models.h"
#include "continuum/model.h"
#include "coupling/base/signals.h"
#include "coupling/base/version.h"
#include "coupling/case/keys.h"
#include "coupling/case/study.h"
#include "coupling/result/judgement.h"
#include "coupling/run/finished_runs.h"
#include "coupling/run/study_result.h"
#include "coupling/run/sweep.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/output_folder.h"
#include "dem/storage_failed.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr std::string_view kEnd = "# end\n";  // of an identity: one without it was cut

std::string identity(const Case& value) {
  return "# grainfield " + version() + "\n" + grain_keys_text(value) + std::string(kEnd);
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

// The folder of a run with its checkpoint. Rank 0 makes and removes what is in it.
class Workplace {
 public:
  explicit Workplace(const std::string& folder)
      : folder_(folder), checkpoint_(folder_ / "checkpoint") {}

  void open(const Case& value, const RunOptions& options) {
    results_ = std::make_unique<OutputFolder>(
        folder_.string(), value.command.empty() ? "grainfield run" : value.command);
    results_->require_other_than(value.get<GrainFiles>().files);
    std::error_code unknown;
    if (fs::equivalent(folder_ / "case.toml", options.case_file, unknown)) {
      throw std::invalid_argument(fmt::format(
          "-o: {}/case.toml is the case itself and would be replaced; name another folder",
          folder_.string()));
    }
    results_->require_free(names_of_results(value));
    require_own_checkpoint();
    if (holds_work()) take_up(value, options);
    std::error_code error;
    const bool fresh = !fs::exists(checkpoint_, error);
    fs::create_directories(checkpoint_);
    remove_orphans(checkpoint_.string());
    try {
      write_text_file((checkpoint_ / "case.toml").string(), write_case(value));
      write_text_file((checkpoint_ / kIdentity).string(), identity(value));
    } catch (...) {
      // Without them nobody could tell which case it is of.
      if (fresh) fs::remove_all(checkpoint_, error);
      throw;
    }
  }

  bool finished() const { return fs::exists(folder_ / "summary.json"); }

  bool was_stopped() const { return fs::exists(checkpoint_); }

  // Whether a run has begun here, though perhaps not got as far as its first checkpoint.
  bool was_begun() const {
    std::error_code error;
    return was_stopped() || fs::exists(folder_ / ".lock", error) ||
           fs::exists(folder_ / ".partial", error);
  }

  // What is there instead of something to resume, for a message.
  std::string instead() const {
    std::error_code error;
    if (fs::is_directory(folder_, error)) {
      return fs::is_empty(folder_, error) ? "an empty folder" : "a folder without checkpoint/";
    }
    const fs::path above = folder_.has_parent_path() ? folder_.parent_path() : ".";
    std::vector<std::string> begun;
    for (fs::directory_iterator at(above, error); !error && at != fs::directory_iterator();
         at.increment(error)) {
      if (fs::is_directory(at->path() / "checkpoint", error)) {
        begun.push_back(at->path().filename().string());
      }
    }
    const std::string near = continuum::misspelt(folder_.filename().string(), begun);
    return near.empty() ? "no such folder"
                        : fmt::format("no such folder; an unfinished run is in {}", near);
  }

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

  /// Returns the earlier results that are gone (OutputFolder::publish).
  std::vector<fs::path> publish() {
    const HeldSignals held(AfterHold::forget);
    std::vector<fs::path> earlier = results_->publish();
    // Under another name first: half a checkpoint would be taken for an unfinished run.
    const fs::path gone = folder_ / ".checkpoint-gone";
    std::error_code error;
    fs::remove_all(gone, error);  // a kill may have left one
    fs::rename(checkpoint_, gone, error);
    fs::remove_all(gone, error);
    close();
    say_when_stopped(fmt::format("stopped; the results in {} are complete", folder_.string()));
    return earlier;
  }

  // What --resume needs stays.
  void abandon(bool keep_checkpoint) noexcept {
    wait_if_stopping();
    std::error_code error;
    if (!keep_checkpoint) fs::remove_all(checkpoint_, error);
    close();
  }

  // Where results are written before they are moved.
  std::string staging(const std::string& inner = "") const { return results_->staging(inner); }
  std::string checkpoint(const std::string& inner) const { return (checkpoint_ / inner).string(); }

 private:
  static constexpr const char* kIdentity = "grains.txt";

  // Results that this run leaves for certain, as far as their names are known beforehand.
  static std::vector<fs::path> names_of_results(const Case& value) {
    std::vector<fs::path> names{"case.toml", "summary.json"};
    const bool one = value.sweep.key.empty();
    if (value.output.report) names.emplace_back("report.html");
    if (one && value.output.fields) names.insert(names.end(), {"fields.h5", "fields.xdmf"});
    if (one && value.output.snapshots && study_of(value).has_grains()) {
      names.emplace_back("snapshots.h5");
    }
    return names;
  }

  // The folder goes when the run is done: nothing of the user's may be in it.
  void require_own_checkpoint() const {
    std::error_code error;
    for (fs::directory_iterator at(checkpoint_, error); !error && at != fs::directory_iterator();
         at.increment(error)) {
      const std::string name = at->path().filename().string();
      const std::string kind = at->path().extension().string();
      const bool own = name == "case.toml" || name == kIdentity || kind == ".h5" ||
                       kind == ".checkpoint" || kind == ".cpu" || kind == ".part";
      if (own) continue;
      throw std::invalid_argument(fmt::format(
          "{}: is no file of a run, which would remove it with its checkpoint; move it, or name "
          "another folder with -o",
          at->path().string()));
    }
  }

  void close() noexcept { results_.reset(); }

  // A checkpoint is there: whether it is this run's.
  void take_up(const Case& value, const RunOptions& options) const {
    if (!options.resume) {
      throw std::invalid_argument(fmt::format(
          "{}: holds an unfinished run; continue it with --resume, or remove that folder",
          checkpoint_.string()));
    }
    const std::string there = read_text_file((checkpoint_ / kIdentity).string());
    const std::string here = identity(value);
    if (there == here) return;
    if (!there.ends_with(kEnd)) {
      const fs::path aside = unused_name();
      fs::rename(checkpoint_, aside);
      options.note(
          fmt::format("{}: {} is missing or cut, so nobody can tell which case it is of: starting "
                      "anew; what was there is kept in {}",
                      checkpoint_.string(), kIdentity, aside.string()));
      return;
    }
    throw std::invalid_argument(
        fmt::format("{}: is of another case: {}; remove that folder to start over",
                    checkpoint_.string(), first_difference(there, here)));
  }

  fs::path unused_name() const {
    for (int k = 1;; ++k) {
      const fs::path name = folder_ / fmt::format("checkpoint-unknown-{}", k);
      if (!fs::exists(name)) return name;
    }
  }

  fs::path folder_, checkpoint_;
  std::unique_ptr<OutputFolder> results_;
};

// Work of rank 0 alone whose failure all ranks must learn of.
void on_first_rank(const Ranks& ranks, const std::function<void()>& work) {
  std::exception_ptr error;
  if (ranks.first()) {
    try {
      work();
    } catch (...) {
      error = std::current_exception();
    }
  }
  throw_together(ranks, error);
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
           member_file(place, member.suffix, r), static_cast<std::size_t>(&member - &members[0])});
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

// Files of the member's realizations, in their order; none for a study of models alone.
std::vector<std::string> realization_files(const SweepCase& member, const Workplace& place) {
  const Case& value = member.value;
  std::vector<std::string> files;
  for (std::int64_t r = 0; study_of(value).has_grains() && r < value.ensemble.realizations; ++r) {
    files.push_back(member_file(place, member.suffix, r));
  }
  return files;
}

StudyResult analyse(const SweepCase& member, const Workplace& place, int threads) {
  const Study& study = study_of(member.value);
  const auto start = Clock::now();
  StudyResult out = study.analyse(member.value, realization_files(member, place), threads);
  if (study.has_grains()) out.summary["time.analysis_s"] = seconds_since(start);
  add_warnings(out);
  add_judgement(out.summary, out.comparison.judgement);
  return out;
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
  const auto warn = [&](const std::string& inner, const std::string& what) {
    if (!what.empty() && options.warn) options.warn(inner + what);
  };
  std::vector<StudyResult> results;
  std::exception_ptr error;
  try {
    for (const auto& member : members) {
      options.note(fmt::format("models and comparison{}{}", member.suffix.empty() ? "" : " of ",
                               member.suffix));
      results.push_back(analyse(member, place, options.threads));
    }
  } catch (...) {
    error = std::current_exception();
    // The others wait for this rank inside a common solution and cannot be told (ranks.h).
    if (!grains) throw;
  }
  try {
    throw_together(ranks, error);
    options.note("outputs");
    on_first_rank(ranks, [&] {
      for (std::size_t m = 0; m < members.size(); ++m) {
        const std::string& suffix = members[m].suffix;
        const std::string folder = place.staging(suffix.empty() ? "" : suffix + "/");
        times(m, results[m].summary);
        const std::string inner = suffix.empty() ? "" : suffix + "/";
        const std::string of = suffix.empty() ? "" : suffix + ": ";
        for (const std::string& line : results[m].warnings) warn(of, line);
        warn(inner, write_study(folder, results[m]));
      }
      if (!value.sweep.key.empty()) {
        warn("", write_sweep(place.staging(), value, members, results));
      }
    });
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(e.what() + kept);
  } catch (const ComputationFailed& e) {
    throw ComputationFailed(e.what() + kept);
  } catch (const dem::StorageFailed& e) {
    throw dem::StorageFailed(e.what() + kept);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(e.what() + kept);
  }
}

// The peak of this process so far, MB; Linux counts in units of 1024 bytes.
double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024e-6;
}

std::string how_to_go_on(const RunOptions& options) {
  return fmt::format(
      "stopped; {}/checkpoint holds the state: continue with the same command and --resume",
      options.folder);
}

void compute(const Case& value, const Workplace& place, const Ranks& ranks,
             const RunOptions& options) {
  const auto start = Clock::now();
  const std::vector<SweepCase> members = sweep_cases(value);
  double dem_seconds = 0;
  {
    const PolledSignals polled;  // checkpoints first
    dem_seconds = simulate(members, place, ranks, options);
  }
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
      const bool unfinished = place.holds_work(), finished = place.finished();
      if (options.resume && !unfinished) {
        // A study of models alone that was stopped has nothing to go on from, but is not finished.
        if (finished && !place.was_stopped()) {
          const std::string again = fmt::format(
              ", or analyse its grains again in another folder: --set "
              "'grains.files=[\"{}/snapshots.h5\"]'",
              options.folder);
          throw std::invalid_argument(fmt::format(
              "--resume: the run in {} is finished; leave --resume out to run anew in its place{}",
              options.folder, section_applies(kGrainFilesKeys.name, value.study) ? again : ""));
        }
        if (!place.was_begun()) {
          throw std::invalid_argument(fmt::format(
              "--resume: nothing to resume in {}: found {}; leave --resume out to start anew",
              options.folder, place.instead()));
        }
        options.note(fmt::format("nothing to resume in {} yet: starting anew", options.folder));
      }
      if (!options.resume && finished && !unfinished) {
        options.note(
            fmt::format("{} holds a finished run; this one will take its place", options.folder));
      }
      place.open(value, options);
      opened = true;
    });
    if (ranks.first()) say_when_stopped(how_to_go_on(options));
    compute(value, place, ranks, options);
    on_first_rank(ranks, [&] {
      const std::string gone = gone_note(options.folder, place.publish());
      if (!gone.empty()) options.note(gone);
    });
  } catch (const Interrupted&) {
    if (opened) place.abandon(true);
    throw Interrupted(how_to_go_on(options));
  } catch (...) {
    if (opened) place.abandon(place.holds_work());
    throw;
  }
}

}  // namespace grainfield::coupling
