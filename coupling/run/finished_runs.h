// What earlier runs left, as a new run finds it in grains.files.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "coupling/case/study.h"
#include "dem/run/run.h"

namespace grainfield::coupling {

/// Finished realizations to start from instead of building them.
struct GrainFiles {
  std::vector<std::string> files;  ///< empty: they are built
};

/// Its key.
void declare_grain_files_keys(SectionKeys s);
inline constexpr KeySection kGrainFilesKeys{"grains", KeyRole::grains, declare_grain_files_keys};

/// The snapshots of one realization: a group of a file.
struct FinishedRun {
  std::string file;
  std::string group;  ///< "/realization_003", or "" where the snapshots stand at the top
};

/// Realization `number` of grains.files: every group of these files that holds snapshots of all the
/// names, in the order of files and groups. `study` is the one that leaves such files. Throws
/// std::invalid_argument "grains.files: ..." naming a file without such a group, or what reading it
/// says; "ensemble.realizations: ..." when there are fewer.
FinishedRun finished_run(const Case& value, std::int64_t number,
                         const std::vector<std::string>& snapshots, const std::string& study);

/// What a finished run left, as a run that is done: there is nothing to advance or to save.
std::unique_ptr<dem::Run> run_of(dem::RunResult result);

/// One line where grains.files hold more realizations than the case takes; else empty. Throws as
/// finished_run.
std::string unused_runs(const Case& value, const std::vector<std::string>& snapshots,
                        const std::string& study);

/// Makes the run of every realization in grains.files and lets it go again, as far as a check may:
/// within 4 s in all, and where the files hold no more than 16 MB of numbers. Throws as
/// finished_run and as `make`.
void try_finished_runs(const Case& value, const std::vector<std::string>& snapshots,
                       const std::string& study,
                       const std::function<void(const FinishedRun&)>& make);

}  // namespace grainfield::coupling
