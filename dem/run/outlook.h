// What a study will take and whether it can be set up, from its setup alone: no engine is made.
#pragma once
#include <string>

#include "dem/engine/engine.h"

namespace grainfield::dem {

/// Most grains of a realization, with fixed ones.
inline constexpr double kMostGrains = 1e7;
/// Most time steps of a realization: at a million of them a second, eleven days of one grain.
inline constexpr double kMostSteps = 1e12;

/// The size of a realization.
struct Outlook {
  double grains = 0;       ///< without fixed ones, an estimate where rows are dropped; 0: not known
  double fixed = 0;        ///< grains of a rough floor
  double bytes = 0;        ///< of memory while it runs, about; 0: not known
  std::string bytes_key;   ///< what that memory is due to: "source.grains"
  double time_step = 0;    ///< s; 0: not known
  std::string step_bound;  ///< what sets it: "the dashpots"; empty: not known
  double time = 0;         ///< s that will be simulated at least; 0: not known
  std::string time_key;    ///< what most of that time is due to: "source.interval"

  void take_step(const EngineSettings& settings) {
    time_step = settings.time_step;
    step_bound = settings.step_bound;
  }
};

/// Memory of a grain with its contacts, its place in checkpoints and snapshots, bytes; half a
/// million disks of a lattice take 2.3 kB each.
inline constexpr double kBytesOfDisk = 2500, kBytesOfPolygon = 4000, kBytesOfSphere = 4000;

/// Throws std::invalid_argument: "KEY: found FOUND UNIT, allowed: up to MOST UNIT WHY".
[[noreturn]] void too_many(const std::string& key, double found, double most,
                           const std::string& unit, const std::string& why);
/// "10 million grains", of kMostGrains.
std::string ten_million();

/// Adds the parts of a time; the key of the largest part is the one to name.
class Times {
 public:
  void add(const std::string& key, double time);
  void put_into(Outlook& out) const;

 private:
  double sum_ = 0, most_ = 0;
  std::string key_;
};

}  // namespace grainfield::dem
