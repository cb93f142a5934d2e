// What study pile-fields looks at, one topic a file. A new topic is one file and one line in
// topics() (study.cc).
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "coupling/report/report.h"
#include "coupling/result/figure.h"
#include "coupling/result/tables.h"
#include "coupling/store/field_io.h"

namespace grainfield::coupling {

class PileSet;

/// What a topic leaves.
struct TopicResult {
  std::string sentence;                                    ///< what was found, one line
  Summary summary;                                         ///< keys of the topic's figures
  NamedFields fields;                                      ///< for fields.h5, heap's frame, m
  std::vector<std::pair<std::string, std::string>> texts;  ///< further files: name, content
  std::vector<Section> sections;                           ///< of the report: pictures first
};

struct Topic {
  std::string name;     ///< the word of fields.topics
  std::string meaning;  ///< for people, a few words
  /// Looks at the piles. The bits do not depend on threads. Throws std::invalid_argument for
  /// snapshots that do not belong together.
  TopicResult (*evaluate)(const PileSet&);
  std::vector<SummaryKey> (*figures)();  ///< what it leaves in summary.json
};

/// In the order of the report.
const std::vector<Topic>& topics();

/// How many grains an RVE needs (Roul figs 2.8-2.10).
Topic rve_size_topic();
/// The five strain measures on the same points (Roul 3.8).
Topic strain_measures_topic();
/// K, G, E, nu over the heap (Roul 3.10).
Topic elastic_topic();
/// Fabric, its relation to stress, strain and density, coordination, orientation (Roul 3.5, 3.9).
Topic fabric_topic();
/// Base forces, contact angles, chains, incremental invariants, Mohr-Coulomb (Roul 3.2, 3.9, 4.2).
Topic forces_topic();

}  // namespace grainfield::coupling
