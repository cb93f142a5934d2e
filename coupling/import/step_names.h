// Time steps and series that the names of files tell.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coupling/import/row_keys.h"

namespace grainfield::coupling {

/// What a file holds, as far as it tells whether files are pieces of one step.
struct NamedFile {
  std::string name;
  bool grains = true;                    ///< or contacts
  std::function<RowKeys()> keys = {};    ///< read where they are needed; empty ones: unknown
  std::function<RowKeys()> places = {};  ///< instead of ids, where grains have none
};
struct NamedSteps {
  std::vector<std::optional<long long>> steps;  ///< of each file
  std::vector<std::string> notes;               ///< how they were told where it is not plain
  std::vector<std::string> warnings;            ///< what does not belong together by its numbers
};
/// Steps of files with one state each: the number in which their names differ.
/// Files that have no grain in common are pieces of one step (of several processors). Throws
/// std::invalid_argument where two numbers differ and the grains do not tell which is the step.
NamedSteps steps_of_names(const std::vector<NamedFile>& files);

/// Files of one table written step by step, "pairs_100.dump", "pairs_200.dump", get one word; each
/// other file its own. `steps`: of each file.
std::map<std::string, std::string> series_of_files(
    const std::map<std::string, std::set<long long>>& steps);

}  // namespace grainfield::coupling
