#include "coupling/studies/pile/gravity_changes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "coupling/studies/pile/pile_figures.h"
#include "coupling/studies/pile/simulation.h"
#include "dem/quasistatic/quasistatic.h"

namespace grainfield::dem {
namespace {

// Rest is judged every so many steps.
constexpr long kCheckEvery = 200;
// Steps between two values of a gravity on its way; 20 of them are short beside any ramp.
constexpr long kRampEvery = 20;

double smooth(double s) { return s * s * (3 - 2 * s); }

}  // namespace

GravityChanges::GravityChanges(const ChangeSetup& change, const RestSetup& rest,
                               const EngineSettings& settings, std::string remedy,
                               std::string where)
    : change_(change),
      rest_(rest),
      settings_(settings),
      remedy_(std::move(remedy)),
      where_(std::move(where)),
      changed_(change.gravity.size()),
      reached_(change.gravity.size()) {
  if (!change_.gravity.empty() && change_.method != "newton")
    check_countable("change.ramp_time", change_.ramp_time, settings_.time_step);
  settings_.sleep.on = false;
}

std::size_t GravityChanges::at() const {
  const auto first =
      std::find_if(changed_.begin(), changed_.end(), [](const auto& s) { return !s; });
  return static_cast<std::size_t>(first - changed_.begin());
}

std::string GravityChanges::name(std::size_t k) const {
  return fmt::format("gravity_{:g}", change_.gravity[k]);
}

std::string GravityChanges::phase() const { return done() ? "done" : name(at()); }

double GravityChanges::fraction() const {
  if (changed_.empty()) return 1;
  double finished = 0;
  for (const auto& state : changed_) finished += state ? 1 : 0;
  if (engine_) finished += rest_progress(engine_->measure(), rest_);
  return finished / static_cast<double>(changed_.size());
}

void GravityChanges::advance(long steps, const std::function<bool(double)>& watch) {
  if (done()) return;
  if (change_.method == "newton") {
    solve(at(), watch);
  } else {
    move(at(), steps);
  }
}

void GravityChanges::solve(std::size_t k, const std::function<bool(double)>& watch) {
  const double gravity = change_.gravity[k];
  QuasistaticSettings settings;
  settings.unbalanced_force_ratio = change_.unbalanced_force_ratio;
  if (watch) {
    const double before = fraction();
    settings.go_on = [&, before](double share) {
      return watch(before + share / static_cast<double>(changed_.size()));
    };
  }
  try {
    QuasistaticResult r =
        relax(packing_, settings_, Vec3(0, -gravity, 0), AppliedForce{}, settings);
    keep(k, std::move(r.state),
         {r.unbalanced_force_ratio, static_cast<double>(r.steps),
          static_cast<double>(r.iterations)});
  } catch (const RelaxationStopped&) {
    return;
  } catch (const ComputationFailed& failure) {
    throw ComputationFailed(
        fmt::format("change.gravity = {:g}{}: {}; or set change.method = damped", gravity, where_,
                    failure.what()));
  }
}

void GravityChanges::move(std::size_t k, long steps) {
  if (!engine_) {
    engine_ = make_engine(settings_, packing_);
    engine_->set_background_damping(rest_.background_damping);
    steps_ = 0;
  }
  const auto on_the_way = static_cast<long>(std::ceil(change_.ramp_time / settings_.time_step));
  const double from = packing_.gravity.norm(), to = change_.gravity[k];
  while (steps > 0) {
    // By where a stretch has begun: a stop may fall into the last one of the ramp.
    const bool ramp = steps_ - steps_ % kRampEvery < on_the_way;
    const long every = ramp ? kRampEvery : kCheckEvery;
    const long chunk = std::min(steps, every - steps_ % every);
    engine_->step(chunk);
    steps_ += chunk;
    steps -= chunk;
    if (steps_ % every != 0) return;
    if (ramp) {
      const double share =
          std::min(1.0, static_cast<double>(steps_) / static_cast<double>(on_the_way));
      engine_->set_gravity(0, -(from + (to - from) * smooth(share)));
      continue;
    }
    const Diagnostics d = engine_->measure();
    if (at_rest(d, rest_)) {
      Reached reached;
      reached.unbalanced_force_ratio = d.unbalanced_force_ratio;
      keep(k, engine_->snapshot(), reached);
      engine_.reset();
      return;
    }
    if (static_cast<double>(steps_ - on_the_way) * settings_.time_step > rest_.max_time) {
      fail_to_rest(d, rest_, fmt::format("under a gravity of {:g} m/s2{}", to, where_), remedy_);
    }
  }
}

void GravityChanges::keep(std::size_t k, Snapshot state, const Reached& reached) {
  state.attributes = packing_.attributes;
  state.attributes["state"] = name(k);
  changed_[k] = std::move(state);
  reached_[k] = reached;
}

void GravityChanges::visit(Archive& archive) {
  for (std::size_t k = 0; k < changed_.size(); ++k) archive.snapshot(changed_[k], name(k));
  archive(reached_);
  archive.require(reached_.size() == changed_.size());
  archive(steps_);
  archive.engine(engine_, [this] {
    std::unique_ptr<Engine> engine = make_engine(settings_);
    for (const Wall& wall : packing_.walls) engine->add_wall(wall);
    return engine;
  });
}

void GravityChanges::add_to(RunResult& result) const {
  for (std::size_t k = 0; k < changed_.size(); ++k) {
    if (!changed_[k]) continue;
    result.snapshots.emplace_back(name(k), *changed_[k]);
    add_change_figures(packing_, *changed_[k], name(k), result.figures);
    add_reached("change." + name(k), reached_[k], result.figures);
  }
}

}  // namespace grainfield::dem
