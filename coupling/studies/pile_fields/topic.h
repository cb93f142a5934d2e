// What study pile-fields looks at, one topic a file. A new topic is one function and one line in
// topics.cc.
#pragma once
#include <string>
#include <vector>

namespace grainfield::coupling {

class PileSet;
struct TopicResult;

struct Topic {
  std::string name;     ///< the word of fields.topics
  std::string meaning;  ///< for people, a few words
  /// Looks at the piles. The bits do not depend on threads. Throws std::invalid_argument for
  /// snapshots that do not belong together.
  TopicResult (*evaluate)(const PileSet&);
};

/// In the order of the report.
const std::vector<Topic>& topics();

/// How many grains an RVE needs (Roul figs 2.8-2.10).
TopicResult rve_size_of_piles(const PileSet& piles);
/// The five strain measures on the same points (Roul 3.8).
TopicResult strain_measures_of_piles(const PileSet& piles);
/// K, G, E, nu over the heap (Roul 3.10).
TopicResult elastic_constants_of_piles(const PileSet& piles);
/// Fabric, its relation to stress, strain and density, coordination, orientation (Roul 3.5, 3.9).
TopicResult fabric_of_piles(const PileSet& piles);
/// Base forces, contact angles, chains, incremental invariants, Mohr-Coulomb (Roul 3.2, 3.9, 4.2).
TopicResult forces_of_piles(const PileSet& piles);

}  // namespace grainfield::coupling
