// What a study will take and whether it can be set up, from its setup alone: no engine is made.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/study/setup.h"

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

/// Throws std::invalid_argument naming the key, as make_point_load_run would for any of these
/// seeds, and for more than kMostGrains. Where grains are drawn beforehand at most `draws` of them
/// are; if more would be, limits that depend on them are taken a little tighter.
Outlook foresee_point_load(const PointLoadSetup& setup, const std::vector<std::uint64_t>& seeds,
                           std::int64_t draws);
/// The same for make_pile_run.
Outlook foresee_pile(const PileSetup& setup, const std::vector<std::uint64_t>& seeds,
                     std::int64_t draws);
/// The same for make_lattice_pile_run.
Outlook foresee_lattice_pile(const LatticePileSetup& setup);
/// Of the changes of gravity of a pile that stands already: the time alone.
Outlook foresee_changes(const ChangeSetup& change);

}  // namespace grainfield::dem
