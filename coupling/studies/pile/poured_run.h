// The run of a pile: its phases are in pile.cc, its sources in pile_pour.cc, progress, checkpoints
// and results in pile_state.cc. Internal to this folder, and to the benchmark of sleeping.
#pragma once
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupling/specimen/surface.h"
#include "coupling/studies/pile/gravity_changes.h"
#include "coupling/studies/pile/pile_groundwork.h"
#include "dem/pouring/source.h"
#include "dem/run/phased_run.h"

namespace grainfield::dem {

/// Share of a run with changes of gravity at which the pile is at rest, for the progress.
inline constexpr double kEndOfRest = 0.85;
/// While grains are poured their motion is read every so many steps, to count those awake.
inline constexpr long kSampleEvery = 3000;

enum class PilePhase : int { pour, settle, rest, change, done };

class PileRun final : public PhasedRun<PileGroundwork, PilePhase> {
 public:
  PileRun(const PileSetup& setup, std::uint64_t seed, int threads);

  void advance(long steps) override;
  RunResult result() const override;

  /// No grain sleeps from now on: what sleeping saves is measured so.
  void keep_awake() { engine_->set_sleep(false); }
  double time_step() const { return settings_.time_step; }

 private:
  // A grain out of the funnel on its way down.
  struct Flight {
    long step = 0;  // at which it joins the simulation
    int grain = 0;
    int pad = 0;
    double x = 0;
  };

  void visit(Archive& archive) override;
  std::unique_ptr<Engine> empty_engine() const override;
  const Engine& at_work() const override;
  double share(const Diagnostics& state) const override;
  std::string phase_name() const override;
  void add_floor_grains();
  long next_event() const;
  void decide() override;
  void pour_point();
  void pour_line();
  void release_grain();
  bool join(const Flight& flight);
  void drop_layer();
  void end_pour();
  void record(int grains);
  std::string record_name(std::size_t k) const;
  void settle();
  void rest();
  void change(long steps);
  bool settled(int grains) const;

  Random random_;
  PileGrains drawn_;  // before anything moves
  double largest_diameter_ = 0, mean_diameter_ = 0;
  std::optional<PointSource> point_;
  int poured_ = 0;  // released by the point source, dropped by the line source
  double top_ = 0;  // of the grains at rest when the last one joined, m
  std::deque<Flight> in_flight_;
  coupling::Stretch line_;  // of the last layer
  long layer_start_ = 0;    // step within the phase
  int layer_grains_ = 0;
  double awake_sum_ = 0;
  long awake_samples_ = 0;
  double pour_time_ = 0;
  Diagnostics at_pile_;                            // when the pile was at rest
  std::vector<std::optional<Snapshot>> recorded_;  // of setup_.record, those that were reached
  std::optional<Snapshot> poured_pile_;            // before the last relaxation
  std::optional<Snapshot> pile_;
  std::optional<GravityChanges> changes_;
};

}  // namespace grainfield::dem
