// Piles of earlier runs, as a new run finds them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "coupling/case/case.h"

namespace grainfield::coupling {

/// A snapshot "pile" with its changed states, in one group of a file.
struct FinishedPile {
  std::string file;
  std::string group;  ///< "/realization_003", or "" where "/pile" stands at the top
};

/// Every group of the files that holds a snapshot "pile", in the order of files and groups. Throws
/// std::invalid_argument "grains.files: ..." naming a file without one, or what reading it says.
std::vector<FinishedPile> finished_piles(const std::vector<std::string>& files);

/// Pile `number` of grains.files. Throws as finished_piles, or when there are fewer piles than
/// ensemble.realizations.
FinishedPile finished_pile(const Case& value, std::int64_t number);

}  // namespace grainfield::coupling
