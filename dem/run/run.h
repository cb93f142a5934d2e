// A realization as a resumable sequence of phases. What a study simulates implements Run.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "dem/shared/computation_failed.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

struct Progress {
  std::string phase;          ///< "deposit row 3/16", "rest", "load", "hold"
  double fraction = 0;        ///< of the whole realization, an estimate in [0, 1]
  double simulated_time = 0;  ///< s
  long steps = 0;
  int grains = 0;             ///< grains in motion or at rest so far, without fixed ones
  int awake = 0;              ///< of these, those that do not sleep
  double kinetic_energy = 0;  ///< J
  double unbalanced_force_ratio = 0;
};

/// What a finished realization leaves.
struct RunResult {
  std::vector<std::pair<std::string, Snapshot>>
      snapshots;                          ///< e.g. {"unloaded", ..}, {"loaded", ..}
  std::map<std::string, double> figures;  ///< summary keys, e.g. "dem.grains", "base.weight_ratio"
};

/// A checkpoint that is whole, but of another setup or seed.
class OtherSetup : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

class Run {
 public:
  virtual ~Run() = default;
  /// At most this many time steps; returns early when done. Throws ComputationFailed.
  virtual void advance(long steps) = 0;
  virtual bool done() const = 0;
  virtual Progress progress() const = 0;
  /// Everything needed to continue to the same bits. Writes beside and renames. Throws
  /// StorageFailed (dem/storage_failed.h); what stood there before is then still there.
  virtual void save(const std::string& file) const = 0;
  /// Continues from a file that save() wrote for the same setup and seed; throws OtherSetup when it
  /// is another one's, std::invalid_argument when it is broken. The run is then of no use any more.
  virtual void restore(const std::string& file) = 0;
  /// Valid once done().
  virtual RunResult result() const = 0;

  /// Called from inside an advance() that takes long, with the state so far; false asks it to
  /// return as soon as it can, as it was before.
  void set_watch(std::function<bool(const Progress&)> watch) { watch_ = std::move(watch); }

 protected:
  /// Asks the watch with progress() in this phase, the share of what is left that is done; empty
  /// without a watch.
  std::function<bool(double)> watch_of(const char* phase) const {
    if (!watch_) return nullptr;
    return [this, phase](double share) {
      Progress now = progress();
      now.phase = phase;
      now.fraction += (1 - now.fraction) * share;
      return watch_(now);
    };
  }

  std::function<bool(const Progress&)> watch_;
};

}  // namespace grainfield::dem
