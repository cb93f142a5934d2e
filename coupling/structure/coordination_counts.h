// How many grains have how many contacts.
#pragma once
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Contacts of the free grains. One with a wall or fixed grain counts for the free grain.
struct CoordinationCounts {
  int grains = 0;
  int rattlers = 0;               ///< grains that bear nothing (grain_facts.h)
  std::vector<int> with;          ///< with[k]: grains that have k contacts
  std::vector<int> with_bearing;  ///< no rattlers, and only their force-bearing contacts
  double mean = 0;                ///< contacts per grain; nan without grains
  double mean_bearing = 0;        ///< the same without rattlers; nan when all are
};

CoordinationCounts coordination_counts(const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
