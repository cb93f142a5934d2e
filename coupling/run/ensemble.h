// Realizations of grains, side by side on threads and ranks, with checkpoints.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "coupling/case/case.h"
#include "coupling/run/ranks.h"
#include "dem/run/run.h"

namespace grainfield::coupling {

/// The seed of realization `index` of an ensemble: SplitMix64's output function of
/// seed + (index + 1) * 0x9E3779B97F4A7C15. Neighbouring seeds and indices give unrelated streams.
std::uint64_t realization_seed(std::uint64_t seed, std::uint64_t index);
/// That of the case's realization `number`, from its ensemble.seed.
std::uint64_t realization_seed(const Case& value, std::int64_t number);
/// Those of all its realizations.
std::vector<std::uint64_t> realization_seeds(const Case& value);

/// One realization to be done.
struct Task {
  /// The simulation at its beginning; its bits do not depend on the threads.
  std::function<std::unique_ptr<dem::Run>(int threads)> make;
  std::string file;      ///< where its result goes; beside it FILE.checkpoint while it runs
  std::size_t kind = 0;  ///< tasks of one kind need about the same time for the same part
};

struct EnsembleProgress {
  std::string phase;          ///< of the realization that is least far
  int done = 0, total = 0;    ///< realizations of this rank, with those of earlier starts
  double fraction = 0;        ///< of all work of this rank
  double simulated_time = 0;  ///< s, of the same realization
  int grains = 0;
  int awake = 0;              ///< of these, those that do not sleep; 0: not counted
  double kinetic_energy = 0;  ///< J
  double unbalanced_force_ratio = 0;
  double seconds_left = 0;  ///< an estimate (time_left.h); negative: not known yet
};

struct EnsembleOptions {
  int threads = 1;
  double checkpoint_seconds = 30;  ///< wall time between checkpoints of a realization
  long stop_after_steps = 0;       ///< > 0: act as if interrupted when a realization gets there
  std::function<void(const EnsembleProgress&)> progress;  ///< about five times a second
  std::function<void(const std::string&)> note;  ///< one line about a file that starts again
};

/// Does the tasks whose file does not exist yet (those of other ranks are done there: task t on
/// rank t mod size) and waits for all ranks. With fewer tasks than threads each run gets several.
/// Continues from checkpoints beside the files. A file or a checkpoint that is broken counts as
/// none, which is noted (on the first rank those of all): the realization starts again
/// and ends in the same bits. One that cannot be read now (dem/cannot_read_now.h) stays as it is
/// and is thrown. Throws what the first failing task (by number) threw, on every rank;
/// Interrupted, after all runs are saved, when stopped. Beside each file it leaves FILE.cpu, what
/// cpu_seconds reads.
void run_tasks(const std::vector<Task>& tasks, const Ranks& ranks, const EnsembleOptions& options);

/// CPU time that the realization of this file took, s: of the thread that steps it, times the
/// threads it had; all starts together, so that it can be told of a run that was resumed. nan where
/// it was not recorded.
double cpu_seconds(const std::string& file);

}  // namespace grainfield::coupling
