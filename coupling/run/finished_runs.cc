#include "coupling/run/finished_runs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "coupling/run/ensemble.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

std::vector<std::string> groups_of(const std::string& file) {
  try {
    return dem::list_snapshots(file);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(std::string("grains.files: ") + e.what());
  }
}

}  // namespace

FinishedRun finished_run(const Case& value, std::int64_t number,
                         const std::vector<std::string>& snapshots, const std::string& study) {
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
  return there[static_cast<std::size_t>(number)];
}

std::unique_ptr<dem::Run> make_pile(const Case& value, const dem::PileSetup& setup,
                                    std::int64_t number, int threads) {
  if (value.grains.files.empty()) {
    return dem::make_pile_run(setup, realization_seed(value, number), threads);
  }
  const FinishedRun pile = finished_run(value, number, {"pile"}, "pile");
  return dem::make_pile_change_run(setup, pile.file, pile.group, threads);
}

}  // namespace grainfield::coupling
