// How the grains of a pile are poured: one by one through a funnel, or in layers on its plateau.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/specimen/surface.h"
#include "coupling/studies/pile/pile_checks.h"
#include "coupling/studies/pile/poured_run.h"
#include "dem/pouring/funnel.h"

namespace grainfield::dem {
namespace {

// A grain out of the funnel joins the simulation this many mean diameters above the pile, ...
constexpr double kEntryMargin = 10;
// ... or this many steps later when a grain that has bounced up there is in its place.
constexpr long kRetryEvery = 10;
// ... but at most this, s, for a layer and for the whole pile.
constexpr double kMaxSettleTime = 2;
// Diameters: what is lower than this below the plateau's middle belongs to the flanks. A plateau
// shorter than kPoint diameters is the pile's point.
constexpr double kPlateauDrop = 1.5, kPoint = 3;

}  // namespace

void PileRun::pour_point() {
  if (!in_flight_.empty() && in_flight_.front().step <= phases_.steps()) {
    if (join(in_flight_.front())) {
      record(in_flight_.front().grain + 1);
      in_flight_.pop_front();
    } else {
      in_flight_.front().step = phases_.steps() + kRetryEvery;
      check_not_waiting(
          setup_,
          static_cast<double>(phases_.steps() - point_->release_step(in_flight_.front().grain)) *
              engine_->time_step());
    }
  }
  if (poured_ < setup_.source.grains && point_->release_step(poured_) == phases_.steps()) {
    release_grain();
  }
  if (phases_.steps() == (awake_samples_ + 1) * kSampleEvery) {
    awake_sum_ += engine_->motion().awake;
    ++awake_samples_;
  }
  if (poured_ == setup_.source.grains && in_flight_.empty()) end_pour();
}

void PileRun::release_grain() {
  if (setup_.source.above == 0) check_mouth(setup_, top_, largest_diameter_);
  Flight f;
  f.grain = poured_;
  // Between plates anywhere, else near the axis.
  const bool funnel = setup_.source.opening > 0;
  const double half_width = funnel ? funnel_room(setup_.source, drawn_.poured[poured_].radius)
                                   : setup_.source.spread * 0.5 * mean_diameter_;
  f.x = point_->axis(poured_) + half_width * random_.uniform(-1, 1);
  const double near = top_ + kEntryMargin * mean_diameter_ + drawn_.poured[poured_].radius;
  const double entry = funnel ? point_->start_height() : near;
  f.step = setup_.source.above > 0 ? phases_.steps() : point_->arrival_step(poured_, entry);
  // One after the other, and not before those that are to join at this very step.
  if (!in_flight_.empty()) f.step = std::max(f.step, in_flight_.back().step + 1);
  f.step = std::max(f.step, phases_.steps() + 1);
  in_flight_.push_back(f);
  ++poured_;
}

// False when another grain is there.
bool PileRun::join(const Flight& f) {
  const ShapedGrain& shaped = drawn_.poured[f.grain];
  NewGrain g = shaped.at(f.x, 0, setup_.material.density);
  // Between plates it waits at the top for its turn; free flight goes on.
  const bool waits = setup_.source.opening > 0;
  point_->place(g, f.grain, waits ? point_->release_step(f.grain) : phases_.steps());
  const Snapshot now = engine_->snapshot();
  const bool rises = setup_.source.above > 0;
  top_ = rises ? pile_top(now) : resting_top(now, setup_.source.height);
  if (rises) {
    g.y = top_ + setup_.source.above * mean_diameter_ + g.radius;
    g.vy = -setup_.source.speed;
  }
  for (const Grain& other : now.grains) {
    if (other.fixed) continue;
    if (std::hypot(other.position.x() - g.x, other.position.y() - g.y) < other.radius + g.radius) {
      return false;
    }
  }
  check_walls_free(setup_, now, largest_diameter_,
                   static_cast<double>(f.grain + 1) / setup_.source.grains);
  engine_->add(g);
  return true;
}

void PileRun::pour_line() {
  if (poured_ > 0) {
    awake_sum_ += engine_->motion().awake;
    ++awake_samples_;
    const double fall =
        std::sqrt(2 * (setup_.source.clearance + largest_diameter_) / setup_.material.gravity);
    const double since = static_cast<double>(phases_.steps() - layer_start_) * engine_->time_step();
    if (since < 1.5 * fall) return;
    if (!settled(layer_grains_) && since < kMaxSettleTime) return;
  }
  if (poured_ == setup_.source.grains) {
    end_pour();
  } else {
    drop_layer();
  }
}

void PileRun::drop_layer() {
  record(poured_);
  double bottom = setup_.source.clearance;
  if (poured_ > 0) {
    const Snapshot now = engine_->snapshot();
    check_walls_free(setup_, now, largest_diameter_,
                     static_cast<double>(poured_) / setup_.source.grains);
    const coupling::Surface surface = coupling::free_surface(now, mean_diameter_);
    const double plateau =
        coupling::plateau_of(surface, line_, kPlateauDrop * mean_diameter_).length();
    const double middle = 0.5 * (line_.left + line_.right) + setup_.source.shift;
    line_ = {middle - 0.5 * plateau, middle + 0.5 * plateau};
    const double end = 0.5 * setup_.floor.length;
    if (line_.left < -end || line_.right > end) {
      throw ComputationFailed(fmt::format(
          "a layer from {:.3g} to {:.3g} m would fall beyond the floor, which ends at {:g} m on "
          "either side, after {} grains; lower source.shift or raise floor.length",
          line_.left, line_.right, end, poured_));
    }
    if (line_.length() < kPoint * largest_diameter_) {
      check_line_long_enough(setup_, poured_);
      end_pour();
      return;
    }
    bottom += *std::max_element(surface.top.begin(), surface.top.end());
  }
  std::vector<ShapedGrain> layer;
  double room = line_.length();
  while (poured_ < setup_.source.grains && 2 * drawn_.poured[poured_].radius <= room) {
    room -= 2 * drawn_.poured[poured_].radius;
    layer.push_back(drawn_.poured[poured_++]);
  }
  for (NewGrain g :
       side_by_side(layer, line_.left, line_.right, bottom, setup_.material.density, random_)) {
    g.vy = -setup_.source.speed;
    engine_->add(g);
  }
  layer_start_ = phases_.steps();
  layer_grains_ = static_cast<int>(layer.size());
}

void PileRun::end_pour() {
  record(poured_);
  pour_time_ = in_phase();
  enter(PilePhase::settle);
}

void PileRun::settle() {
  // The last grain is still in the air, and the pile sleeps: its energy counts as that of one.
  const double fall = std::sqrt(2 * kEntryMargin * mean_diameter_ / setup_.material.gravity);
  if (in_phase() < 2 * fall) return;
  if (!settled(1) && in_phase() < kMaxSettleTime) return;
  const Snapshot now = engine_->snapshot();
  check_walls_free(setup_, now, largest_diameter_, 1);
  check_funnel_empty(setup_, now);
  poured_pile_ = now;
  engine_->set_sleep(false);
  enter(PilePhase::rest);
}

}  // namespace grainfield::dem
