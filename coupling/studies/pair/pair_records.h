// What is kept of a pair as it goes on, and the snapshots and columns that come of it.
#pragma once
#include <vector>

#include "coupling/studies/pair/pair_bodies.h"

namespace grainfield::dem {

struct PairRecord {
  double time = 0, kinetic = 0, stored = 0, dissipated = 0;  ///< s, J
  PairState first, second;
  PairForces forces;
};

/// Keeps every n-th record and the last, n twice as large whenever there are more than twice the
/// number wanted.
struct PairRecords {
  std::vector<PairRecord> kept;
  long seen = 0, every = 1;

  void add(const PairRecord& record, int wanted);
  template <class Archive>
  void visit(Archive& archive) {
    archive(kept);
    archive(seen);
    archive(every);
  }
};

/// Some of them as snapshots, the deepest among them; the columns in the first one's attributes.
std::vector<std::pair<std::string, Snapshot>> snapshots_of(const PairRecords& records,
                                                           const PairBodies& bodies);

}  // namespace grainfield::dem
