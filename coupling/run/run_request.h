// A run as its user asks for it.
#pragma once
#include <string>

#include "coupling/case/case.h"
#include "coupling/result/tables.h"
#include "coupling/run/ranks.h"
#include "coupling/run/run_case.h"

namespace grainfield::coupling {

struct RunRequest {
  std::string file;    ///< case file, or the name of a shipped case
  std::string folder;  ///< of the outputs; empty: results/CASE (CASE-quick)
  Overrides sets;      ///< "key.path=value"
  bool quick = false, resume = false;
  int threads = 0;                 ///< 0: all cores; under mpirun one per rank
  double checkpoint_seconds = 30;  ///< wall time between checkpoints
  long stop_after_steps = 0;       ///< for tests: see EnsembleOptions
};

struct RunPlan {
  Case value;
  RunOptions options;  ///< without progress, note and warn
};

/// The case that was asked for and how to run it: run_case(plan.value, ranks, plan.options), with
/// threads_for(plan.options.threads, ranks) threads. MPI is not started. Throws
/// std::invalid_argument as find_case and read_case, and "--checkpoint-seconds: ...".
RunPlan plan_run(const RunRequest& request);

/// `wanted`, or where that is 0 all cores; under mpirun one.
int threads_for(int wanted, const Ranks& ranks);

/// What a summary warns of: grains that overlap by more than a contact law of small overlaps bears;
/// one line. Empty: nothing.
std::string deep_overlap(const Case& value, const Summary& summary);

}  // namespace grainfield::coupling
