// A packing at rest, brought to rest under other gravities: by the quasi-static solver (newton) or
// by slow damped dynamics (damped), each time from the same state.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupling/studies/pile/simulation.h"
#include "dem/engine/engine.h"
#include "dem/run/archive.h"
#include "dem/run/common.h"
#include "dem/run/run.h"
#include "dem/run/setup.h"

namespace grainfield::dem {

class GravityChanges {
 public:
  /// `remedy` completes what is said of a damped change that does not come to rest (fail_to_rest);
  /// `where` stands behind "change.gravity = 5" in what failures say: "" or " of FILE:GROUP".
  GravityChanges(const ChangeSetup& change, const RestSetup& rest, const EngineSettings& settings,
                 std::string remedy, std::string where = "");

  /// The state that every change starts from, at rest under its own gravity.
  void start_from(const Snapshot& packing) { packing_ = packing; }
  /// The state under change.gravity[k] is known already.
  void set_known(std::size_t k, Snapshot state) { changed_[k] = std::move(state); }

  /// At most this many time steps, or one solve, with the share of it that is done told to `watch`
  /// (empty: nobody): false stops it where it was. Throws ComputationFailed.
  void advance(long steps, const std::function<bool(double)>& watch);
  bool done() const { return at() == changed_.size(); }
  std::size_t count() const { return changed_.size(); }
  /// Share of all the changes that is done, in [0, 1].
  double fraction() const;
  /// "gravity_5": the change at work.
  std::string phase() const;
  /// The damped dynamics at work, or null.
  const Engine* engine() const { return engine_.get(); }

  /// Shows all that changes; reading, start_from() must have been called before.
  void visit(Archive& archive);

  /// Adds the snapshots "gravity_G" and the figures "change.gravity_G.*".
  void add_to(RunResult& result) const;

 private:
  std::size_t at() const;
  std::string name(std::size_t k) const;
  void solve(std::size_t k, const std::function<bool(double)>& watch);
  void move(std::size_t k, long steps);
  void keep(std::size_t k, Snapshot state, const Reached& reached);

  ChangeSetup change_;
  RestSetup rest_;
  EngineSettings settings_;
  std::string remedy_, where_;
  Snapshot packing_;
  std::vector<std::optional<Snapshot>> changed_;  // one per change.gravity, in its order
  std::vector<Reached> reached_;
  std::unique_ptr<Engine> engine_;  // of the damped change at work
  long steps_ = 0;                  // of it
};

}  // namespace grainfield::dem
