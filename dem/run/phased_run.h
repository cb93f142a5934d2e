// A run of one engine through phases: what such runs have in common whatever they simulate.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dem/run/archive.h"
#include "dem/run/fingerprint.h"
#include "dem/run/groundwork.h"
#include "dem/run/phases.h"

namespace grainfield::dem {

/// Whoever derives from it sets settings_ and engine_, lists in visit() the phases, what else
/// changes, and the engine, and decides at the end of each kCheckEvery steps of a phase what
/// follows.
template <Groundwork G, class Phase>
class PhasedRun : public ArchivedRun {
 public:
  using Setup = typename G::Setup;

  void advance(long steps) override {
    while (steps > 0 && !done()) {
      if (acts_at_once()) return;
      steps -= phases_.step(*engine_, steps, kCheckEvery);
      if (phases_.is_due(kCheckEvery)) decide();
    }
  }
  bool done() const final { return phases_.done(); }
  Progress progress() const override {
    const Diagnostics d = at_work().measure();
    Progress p = progress_of(at_work(), d);
    p.grains = engine_->grains();
    p.phase = phase_name();
    p.fraction = done() ? 1 : phases_.fraction(share(d));
    return p;
  }

 protected:
  /// Rest and the like are judged every so many steps, counted within a phase: cheap beside the
  /// steps themselves.
  static constexpr long kCheckEvery = 200;

  PhasedRun(const Setup& setup, std::uint64_t seed, std::vector<PhaseInfo> table)
      : setup_(setup), seed_(seed), phases_(std::move(table)) {
    G::check(setup_);
  }

  virtual void decide() = 0;
  /// A phase without steps of the engine does its work here, once an advance().
  virtual bool acts_at_once() { return false; }
  /// With its walls and without grains.
  virtual std::unique_ptr<Engine> empty_engine() const = 0;
  /// The engine whose state progress() tells.
  virtual const Engine& at_work() const { return *engine_; }
  /// Share of the phase that is done, and its name with what has been reached in it.
  virtual double share(const Diagnostics& state) const = 0;
  virtual std::string phase_name() const { return phases_.info().name; }
  std::string fingerprint() const override {
    return fmt::format("{} {} {} {}", G::kName, fingerprint_of(setup_), settings_.time_step, seed_);
  }

  template <class Grains>
  void take_settings(const Grains& grains, int threads) {
    settings_ = G::settings(setup_, grains, 1);
    settings_.threads = threads;
  }
  void add(const std::vector<NewGrain>& grains) {
    for (const NewGrain& g : grains) engine_->add(g);
  }
  void enter(Phase phase) {
    phases_.enter(phase);
    damp();
  }
  void damp() {
    engine_->set_background_damping(phases_.info().damped ? setup_.rest.background_damping : 0);
  }
  /// s since the phase began.
  double in_phase() const { return static_cast<double>(phases_.steps()) * settings_.time_step; }
  /// Throws ComputationFailed (fail_to_rest) when it takes longer than rest.max_time.
  bool has_come_to_rest(const Diagnostics& state, const std::string& when,
                        const std::string& remedy) const {
    if (at_rest(state, setup_.rest)) return true;
    if (in_phase() > setup_.rest.max_time) fail_to_rest(state, setup_.rest, when, remedy);
    return false;
  }
  void visit_engine(Archive& archive) {
    archive.engine(engine_, [this] { return empty_engine(); });
  }

  Setup setup_;
  std::uint64_t seed_;
  EngineSettings settings_;
  std::unique_ptr<Engine> engine_;
  Phases<Phase> phases_;
};

}  // namespace grainfield::dem
