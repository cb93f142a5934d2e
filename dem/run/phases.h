// The phases of a run as data: their names, what holds in them whatever the study does, and how far
// the run has come.
#pragma once
#include <algorithm>
#include <vector>

#include "dem/run/archive.h"

namespace grainfield::dem {

struct PhaseInfo {
  const char* name = "";
  bool damped = false;        ///< with the background damping of the rest
  double begin = 0, end = 0;  ///< share of the whole realization, for the progress
};

/// `Phase`: an enumeration from 0, in the order of the table, its last one the end of the run.
template <class Phase>
class Phases {
 public:
  explicit Phases(std::vector<PhaseInfo> table) : table_(std::move(table)) {}

  Phase now() const { return now_; }
  bool done() const { return static_cast<std::size_t>(now_) + 1 == table_.size(); }
  const PhaseInfo& info() const { return table_[static_cast<std::size_t>(now_)]; }
  /// Begins a phase.
  void enter(Phase phase) {
    now_ = phase;
    steps_ = 0;
  }
  /// Begins the same one again.
  void restart() { steps_ = 0; }

  /// Time steps since the phase began.
  long steps() const { return steps_; }
  void advance(long steps) { steps_ += steps; }
  /// Something that is decided every so many steps is due now, or in so many.
  bool is_due(long every) const { return steps_ % every == 0; }
  long until_due(long every) const { return every - steps_ % every; }

  /// Up to the next decision of those every so many steps, at most `steps`; returns how many.
  long step(Engine& engine, long steps, long every) {
    const long chunk = std::min(steps, until_due(every));
    engine.step(chunk);
    advance(chunk);
    return chunk;
  }

  /// Share of the whole realization, when `share` of this phase is done.
  double fraction(double share) const {
    const PhaseInfo& p = info();
    return p.begin + (p.end - p.begin) * std::clamp(share, 0.0, 1.0);
  }

  void visit(Archive& archive) {
    archive(now_);
    archive(steps_);
    archive.require(static_cast<std::size_t>(now_) < table_.size());
  }

 private:
  std::vector<PhaseInfo> table_;
  Phase now_{};
  long steps_ = 0;
};

}  // namespace grainfield::dem
