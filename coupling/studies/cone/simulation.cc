// A cone: grains fall from above its apex, over the whole floor, or into a cylinder that is lifted.
// Grains that roll beyond the floor are taken away: the engine goes on from a snapshot without
// them.
#include "coupling/studies/cone/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "coupling/studies/cone/cone_grains.h"
#include "dem/run/phased_run.h"
#include "dem/space/rotation.h"

namespace grainfield::dem {
namespace {

// Settled: kinetic energy below this share of m g r for each grain, ...
constexpr double kSettledShare = 1e-3;
// ... but at most this long, s.
constexpr double kMaxSettleTime = 2;
// Places tried for a grain before it waits for the next time.
constexpr int kTries = 20;
// Grains beyond the floor are taken away when they are this share of all.
constexpr double kStrayShare = 0.01;

enum class ConePhase : int { pour, fill_settle, lift, settle, rest, done };

// In the order of ConePhase.
std::vector<PhaseInfo> phases_of(const ConePlan& plan) {
  const double poured = plan.source == "cylinder" ? 0.4 : 0.75;
  return {{"pour", false, 0, poured},    {"settle", false, poured, poured},
          {"lift", false, poured, 0.75}, {"settle", false, 0.75, 0.75},
          {"rest", true, 0.75, 1},       {"done", true, 1, 1}};
}

class ConeRun final : public PhasedRun<ConeGroundwork, ConePhase> {
 public:
  ConeRun(const ConeSetup& setup, std::uint64_t seed, int threads);

  Progress progress() const override;
  RunResult result() const override;

 private:
  void visit(Archive& archive) override;
  std::unique_ptr<Engine> empty_engine() const override;
  double share(const Diagnostics& state) const override;
  std::string phase_name() const override;
  bool acts_at_once() override;
  void decide() override;
  void pour();
  void release(int count);
  bool is_poured() const { return poured_ == setup_.plan.grains; }
  bool settled() const;
  void settle();
  double fall_time() const;
  void begin_lift();
  void lift();
  void rest();
  void check_enough() const;
  // Whether more grains than this share of all are beyond the floor.
  bool strays(double share) const;
  // Goes on without them, and without the cylinder unless `keep_cylinder`.
  void take_away(bool keep_cylinder);

  Random random_;
  std::vector<ShapedGrain> grains_;  // drawn before anything moves
  double mean_mass_ = 0, largest_ = 0;
  int poured_ = 0, lost_ = 0;
  bool cylinder_ = false;  // whether it stands
  double top_ = 0;         // of the grains that lie; while it is lifted: within the cylinder, m
  double filled_ = 0;      // top_ when the lift began
  double pour_time_ = 0, awake_sum_ = 0;
  long awake_samples_ = 0;
  long steps_before_ = 0;  // of the engines before this one
  Diagnostics at_rest_;
  std::optional<Snapshot> pile_;
};

ConeRun::ConeRun(const ConeSetup& setup, std::uint64_t seed, int threads)
    : PhasedRun(setup, seed, phases_of(setup.plan)),
      random_(seed),
      grains_(draw_all<ConeGroundwork>(setup_, random_)) {
  for (const ShapedGrain& g : grains_) {
    mean_mass_ += setup_.material.density * g.area / static_cast<double>(grains_.size());
    largest_ = std::max(largest_, g.radius);
  }
  take_settings(grains_, threads);
  cylinder_ = setup_.plan.source == "cylinder";
  engine_ = empty_engine();
  add(cone_floor(setup_.plan, setup_.material.density));
  enter(ConePhase::pour);
}

std::unique_ptr<Engine> ConeRun::empty_engine() const {
  std::unique_ptr<Engine> engine = make_engine(settings_);
  for (const Wall& wall : cone_walls(setup_, cylinder_)) engine->add_wall(wall);
  return engine;
}

// The first grains.
bool ConeRun::acts_at_once() {
  if (phases_.now() == ConePhase::pour && phases_.steps() == 0 && poured_ == 0) pour();
  return false;
}

void ConeRun::decide() {
  switch (phases_.now()) {
    case ConePhase::pour:
      return pour();
    case ConePhase::fill_settle:
      if (in_phase() < 2 * fall_time()) return;
      if (settled() || in_phase() > kMaxSettleTime) begin_lift();
      return;
    case ConePhase::lift:
      return lift();
    case ConePhase::settle:
      return settle();
    case ConePhase::rest:
      return rest();
    case ConePhase::done:
      return;
  }
}

void ConeRun::pour() {
  awake_sum_ += engine_->motion().awake;
  ++awake_samples_;
  const double due = setup_.plan.rate * (in_phase() + kCheckEvery * settings_.time_step);
  const int wanted = static_cast<int>(std::min<double>(due, setup_.plan.grains));
  if (wanted > poured_) release(wanted - poured_);
  if (is_poured()) {
    pour_time_ = in_phase();
    enter(cylinder_ ? ConePhase::fill_settle : ConePhase::settle);
  } else if (phases_.steps() % (20 * kCheckEvery) == 0 && strays(kStrayShare)) {
    take_away(true);
  }
}

// As many of them as find a free place. Rain begins above the surface where it is, so that it falls
// on flanks no harder than on the top.
void ConeRun::release(int count) {
  const Snapshot now = engine_->snapshot();
  top_ = resting_height(now);
  const ConePlan& plan = setup_.plan;
  const double above = plan.drop + largest_, column = kColumn * largest_;
  if (cylinder_) check_cylinder(setup_, top_ + above + column + largest_);
  std::optional<LocalTops> tops;
  if (plan.source == "rain") tops.emplace(now, plan.floor_radius, 2 * largest_);
  FreePlaces places(now, largest_);
  for (; count > 0; --count) {
    const ShapedGrain& shaped = grains_[static_cast<std::size_t>(poured_)];
    const double reach = source_radius(plan) - (cylinder_ ? shaped.radius : 0);
    bool placed = false;
    for (int k = 0; k < kTries && !placed; ++k) {
      const double r = reach * std::sqrt(random_.uniform());
      const auto [cosine, sine] = rotation_of(2 * std::numbers::pi * random_.uniform());
      const double x = r * cosine, y = r * sine;
      const double low = (tops ? tops->at(x, y) : top_) + above;
      const double z = random_.uniform(low, low + column);
      if (!places.take(x, y, z, shaped.radius)) continue;
      NewGrain g = placed_grain(shaped, x, y, z, setup_.material.density);
      g.vz = -plan.speed;
      engine_->add(g);
      placed = true;
    }
    if (!placed) return;
    ++poured_;
  }
}

bool ConeRun::settled() const {
  const double lift = mean_mass_ * setup_.material.gravity * setup_.plan.radius;
  return engine_->motion().kinetic_energy <= kSettledShare * lift * engine_->grains();
}

// From where grains start to the floor, s.
double ConeRun::fall_time() const {
  const double height = top_ + setup_.plan.drop + (2 + kColumn) * largest_;
  return std::sqrt(2 * height / setup_.material.gravity);
}

void ConeRun::lift() {
  const double lifted = setup_.plan.lift_speed * in_phase();
  if (lifted > top_) {  // its lower rim has passed the highest grain within
    take_away(false);
    enter(ConePhase::settle);
    return;
  }
  if (lifted > 2 * filled_) {
    throw ComputationFailed(
        fmt::format("grains ride up with the cylinder, to {:.3g} m; raise cone.mouth or lower "
                    "material.wall_friction",
                    top_));
  }
  if (phases_.steps() % (10 * kCheckEvery) != 0) return;
  top_ = top_within(engine_->snapshot(), setup_.plan.mouth);
  if (strays(kStrayShare)) take_away(true);
}

void ConeRun::begin_lift() {
  filled_ = top_ = top_within(engine_->snapshot(), setup_.plan.mouth);
  WallMotion up;
  up.velocity = Vec3(0, 0, setup_.plan.lift_speed);
  engine_->set_wall_motion("cylinder", up);
  enter(ConePhase::lift);
}

void ConeRun::settle() {
  // The last grains may still be in the air.
  if (in_phase() < 2 * fall_time()) return;
  if (!settled() && in_phase() < kMaxSettleTime) return;
  if (strays(0)) take_away(false);
  check_enough();
  engine_->set_sleep(false);
  enter(ConePhase::rest);
}

void ConeRun::rest() {
  const Diagnostics d = engine_->measure();
  if (!has_come_to_rest(d, "after the pour", smaller_step(setup_.motion))) return;
  if (strays(0)) {
    take_away(false);
    check_enough();
    return phases_.restart();
  }
  at_rest_ = d;
  pile_ = named_snapshot(
      *engine_, "pile", seed_,
      {{"source", setup_.plan.source}, {"shape", setup_.plan.shape}, {"floor", setup_.plan.floor}});
  phases_.enter(ConePhase::done);
}

void ConeRun::check_enough() const {
  if (engine_->grains() >= kLeastOfCone) return;
  throw ComputationFailed(
      fmt::format("{} of {} grains stayed on the floor, too few for a cone; raise "
                  "cone.floor_radius, cone.grains or material.rolling_friction, or take cone.floor "
                  "= \"rough\"",
                  engine_->grains(), setup_.plan.grains));
}

bool ConeRun::strays(double share) const {
  int count = 0;
  for (const Grain& g : engine_->snapshot().grains) {
    count += !g.fixed && has_left(g, setup_.plan) ? 1 : 0;
  }
  return count > share * engine_->grains();
}

void ConeRun::take_away(bool keep_cylinder) {
  Snapshot s = engine_->snapshot();
  const int before = engine_->grains();
  cylinder_ = cylinder_ && keep_cylinder;
  keep_on_floor(setup_.plan, cylinder_, s);
  steps_before_ += engine_->steps();
  engine_ = make_engine(settings_, s);
  if (phases_.now() == ConePhase::rest) engine_->set_sleep(false);
  damp();
  lost_ += before - engine_->grains();
}

Progress ConeRun::progress() const {
  Progress p = PhasedRun::progress();
  p.steps += steps_before_;
  p.simulated_time = static_cast<double>(p.steps) * settings_.time_step;
  return p;
}

std::string ConeRun::phase_name() const {
  return phases_.now() == ConePhase::pour ? fmt::format("pour {}/{}", poured_, setup_.plan.grains)
                                          : PhasedRun::phase_name();
}

double ConeRun::share(const Diagnostics& state) const {
  switch (phases_.now()) {
    case ConePhase::pour:
      return static_cast<double>(poured_) / setup_.plan.grains;
    case ConePhase::lift:
      return setup_.plan.lift_speed * in_phase() / std::max(top_, 1e-300);
    case ConePhase::rest:
      return rest_progress(state, setup_.rest);
    default:
      return 1;
  }
}

void ConeRun::visit(Archive& archive) {
  phases_.visit(archive);
  archive(poured_);
  archive.require(poured_ >= 0 && poured_ <= setup_.plan.grains);
  archive(lost_);
  archive(cylinder_);
  archive(top_);
  archive(filled_);
  archive(pour_time_);
  archive(awake_sum_);
  archive(awake_samples_);
  archive(steps_before_);
  archive(at_rest_);
  archive(random_);
  visit_engine(archive);
  archive.snapshot(pile_, "pile");
  archive.require(pile_.has_value() == done());
}

RunResult ConeRun::result() const {
  RunResult out;
  if (!done()) return out;
  out.snapshots.emplace_back("pile", *pile_);
  auto& f = out.figures;
  add_engine_figures(*engine_, at_rest_, f);
  f["dem.steps"] += static_cast<double>(steps_before_);
  f["cone.grains_lost"] = lost_;
  f["cone.pour_time"] = pour_time_;
  f["cone.awake_mean"] = awake_sum_ / static_cast<double>(std::max(awake_samples_, 1L));
  return out;
}

}  // namespace

Outlook foresee_cone(const ConeSetup& setup, const std::vector<std::uint64_t>& seeds,
                     std::int64_t draws) {
  return foresee<ConeGroundwork>(setup, seeds, draws);
}

std::unique_ptr<Run> make_cone_run(const ConeSetup& setup, std::uint64_t seed, int threads) {
  return std::make_unique<ConeRun>(setup, seed, threads);
}

}  // namespace grainfield::dem
