#include "coupling/run/finished_runs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "coupling/run/ensemble.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

// Of grains.files, in all, that a check reads: a second's worth.
constexpr std::uintmax_t kReadBytes = 64'000'000;

std::vector<std::string> groups_of(const std::string& file) {
  try {
    return dem::list_snapshots(file);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(std::string("grains.files: ") + e.what());
  }
}

// All that the files hold, at least as many as the case wants.
std::vector<FinishedRun> finished_runs(const Case& value, const std::vector<std::string>& snapshots,
                                       const std::string& study) {
  std::vector<FinishedRun> there;
  for (const std::string& file : value.grains.files) {
    const std::size_t before = there.size();
    const std::vector<std::string> groups = groups_of(file);
    const std::string first = "/" + snapshots.front();
    for (const std::string& group : groups) {
      if (!group.ends_with(first)) continue;
      const std::string above = group.substr(0, group.size() - first.size());
      const bool all = std::all_of(snapshots.begin(), snapshots.end(), [&](const auto& name) {
        return std::find(groups.begin(), groups.end(), above + "/" + name) != groups.end();
      });
      if (all) there.push_back({file, above});
    }
    if (there.size() == before) {
      throw std::invalid_argument(fmt::format(
          "grains.files: {} holds no snapshot named {}, expected snapshots.h5 of a run of study {}",
          file, fmt::join(snapshots, " and "), study));
    }
  }
  const auto count = static_cast<std::int64_t>(there.size());
  if (value.ensemble.realizations > count) {
    throw std::invalid_argument(fmt::format(
        "ensemble.realizations: found {}, allowed: up to {}, the realizations in grains.files",
        value.ensemble.realizations, count));
  }
  there.resize(static_cast<std::size_t>(value.ensemble.realizations));
  return there;
}

}  // namespace

FinishedRun finished_run(const Case& value, std::int64_t number,
                         const std::vector<std::string>& snapshots, const std::string& study) {
  return finished_runs(value, snapshots, study)[static_cast<std::size_t>(number)];
}

void try_finished_runs(const Case& value, const std::vector<std::string>& snapshots,
                       const std::string& study,
                       const std::function<void(const FinishedRun&)>& make) {
  std::uintmax_t bytes = 0;
  std::string last;
  for (const FinishedRun& run : finished_runs(value, snapshots, study)) {
    std::error_code error;
    if (run.file != last) bytes += std::filesystem::file_size(run.file, error);
    if (error || bytes > kReadBytes) return;
    last = run.file;
    make(run);
  }
}

std::unique_ptr<dem::Run> make_pile(const Case& value, const dem::PileSetup& setup,
                                    std::int64_t number, int threads) {
  if (value.grains.files.empty()) {
    return dem::make_pile_run(setup, realization_seed(value, number), threads);
  }
  const FinishedRun pile = finished_run(value, number, {"pile"}, "pile");
  return dem::make_pile_change_run(setup, pile.file, pile.group, threads);
}

dem::Outlook foresee_pile(const Case& value, const dem::PileSetup& setup, std::int64_t draws) {
  if (value.grains.files.empty()) {
    return dem::foresee_pile(setup, realization_seeds(value), draws);
  }
  try_finished_runs(value, {"pile"}, "pile", [&](const FinishedRun& pile) {
    dem::make_pile_change_run(setup, pile.file, pile.group, 1);
  });
  return dem::foresee_changes(setup.change);
}

}  // namespace grainfield::coupling
