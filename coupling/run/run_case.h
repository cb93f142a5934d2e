// A case from start to end: realizations, analysis, outputs, sweeps.
#pragma once
#include <functional>
#include <string>

#include "coupling/case/case.h"
#include "coupling/run/ensemble.h"
#include "coupling/run/ranks.h"

namespace grainfield::coupling {

struct RunOptions {
  std::string folder;     ///< of the outputs; made where missing
  std::string case_file;  ///< that was read; the outputs never replace it
  int threads = 1;
  bool resume = false;             ///< continue from FOLDER/checkpoint where there is one
  double checkpoint_seconds = 30;  ///< see EnsembleOptions
  long stop_after_steps = 0;       ///< for tests: see EnsembleOptions
  std::function<void(const EnsembleProgress&)> progress;
  std::function<void(const std::string&)> note;  ///< one line about what begins now
  std::function<void(const std::string&)> warn;  ///< one line about what results or outputs lack
};

/// Runs a case and leaves its outputs in the folder: they are written into FOLDER/.partial and
/// moved when all are complete, summary.json last. A sweep leaves one folder of outputs per value,
/// and a summary and report of all. FOLDER/checkpoint holds what --resume needs; it is removed on
/// success, and on failure unless it holds grains (the message then says so). Only rank 0 writes
/// outputs.
///
/// Throws std::invalid_argument (folder cannot be written; a checkpoint is there without resume, or
/// of another case), Interrupted saying how to continue, and what simulations and models throw.
void run_case(const Case& value, const Ranks& ranks, const RunOptions& options);

}  // namespace grainfield::coupling
