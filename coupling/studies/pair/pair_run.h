// What collisions and paths of a pair have in common: setup, records, figures.
#pragma once
#include <map>
#include <memory>
#include <string>

#include "coupling/studies/pair/pair_records.h"
#include "coupling/studies/pair/simulation.h"
#include "dem/run/archive.h"

namespace grainfield::dem {

class PairRun : public ArchivedRun {
 public:
  /// Throws std::invalid_argument naming the key (check_pair).
  PairRun(const PairSetup& setup, std::uint64_t seed, int threads);

 protected:
  PairBodies draw() const;
  std::string fingerprint() const override;
  RunResult result_of(const PairBodies& bodies, long steps) const;
  /// Unless it is not finite.
  void add_figure(const std::string& key, double value);

  PairSetup setup_;
  std::uint64_t seed_;
  int threads_;
  PairRecords records_;
  std::map<std::string, double> figures_;
};

/// Free collisions, one after the other, each in an engine of its own, until the bodies part.
std::unique_ptr<Run> make_collision_run(const PairSetup& setup, std::uint64_t seed, int threads);
/// Paths, one after the other, each passed again in finer steps until its work has settled.
std::unique_ptr<Run> make_path_run(const PairSetup& setup, std::uint64_t seed, int threads);

}  // namespace grainfield::dem
