#include "coupling/studies/hard_to_soft/simulation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "dem/random/random.h"
#include "dem/run/archive.h"
#include "dem/run/fingerprint.h"
#include "dem/run/soft_snapshot.h"
#include "dem/snapshot/contact_changes.h"
#include "dem/switching/switching_disks.h"

namespace grainfield::dem {

double HardToSoftSetup::mass() const { return density * std::numbers::pi * radius * radius; }
double HardToSoftSetup::weight() const { return mass() * gravity; }
double HardToSoftSetup::stiffness() const { return weight() / (softness * 2 * radius); }
double HardToSoftSetup::time_step() const {
  return step * 0.1 * std::numbers::pi * std::sqrt(mass() / stiffness());
}
double HardToSoftSetup::time_unit() const { return std::sqrt(2 * radius / gravity); }
double HardToSoftSetup::width() const { return 2.2 * radius * (1 + polydispersity) * columns; }

namespace {

constexpr long kJudgeSoftEvery = 20;
constexpr double kBytesOfSwitchingDisk = 9000;
constexpr std::array<int, 3> kShown{25, 50, 75};  // %

using SwitchRecord = std::array<double, std::size(kSwitchColumns)>;

SwitchScene switch_scene(const HardToSoftSetup& s) {
  SwitchScene out;
  SoftLaw law;
  law.stiffness = s.stiffness();
  law.damping = s.damping * std::sqrt(s.mass() * s.stiffness());
  law.friction = SoftFriction::coulomb;
  law.coulomb = s.coulomb;
  law.tangential_stiffness = s.tangential_ratio * s.stiffness();
  out.soft.grains = law;
  out.soft.gravity = {0, -s.gravity};
  const double half = 0.5 * s.width();
  out.soft.walls = {{{0, 0}, {0, 1}, law}, {{-half, 0}, {1, 0}, law}, {{half, 0}, {-1, 0}, law}};
  out.grains = {s.restitution, s.impact_friction};
  out.walls.assign(3, out.grains);
  return out;
}

// Row above row, each disk in a cell of its own.
std::vector<Body<2>> rain_of(const HardToSoftSetup& s, std::uint64_t seed) {
  Random random(seed);
  const double largest = s.radius * (1 + s.polydispersity), cell = s.width() / s.columns;
  std::vector<Body<2>> out;
  for (int j = 0; j < s.rows; ++j) {
    for (int i = 0; i < s.columns; ++i) {
      Body<2> b;
      b.radius = s.radius * (1 + s.polydispersity * random.uniform(-1, 1));
      const double room = 0.5 * cell - b.radius;
      b.position = {-0.5 * s.width() + (i + 0.5) * cell + 0.9 * room * random.uniform(-1, 1),
                    largest + (j + 1) * 2 * s.radius * s.clearance + j * 2 * largest};
      const double mass = s.density * std::numbers::pi * b.radius * b.radius;
      b.inverse_mass = 1 / mass;
      b.inverse_inertia = 2 / (mass * b.radius * b.radius);
      out.push_back(b);
    }
  }
  return out;
}

ImplicitSettings switch_steps(const HardToSoftSetup& s) {
  ImplicitSettings out;
  out.time_step = s.time_step();
  return out;
}

class HardToSoftRun final : public ArchivedRun {
 public:
  HardToSoftRun(const HardToSoftSetup& setup, std::uint64_t seed)
      : setup_(setup),
        seed_(seed),
        disks_(switch_scene(setup), rain_of(setup, seed), switch_steps(setup)) {
    start_ = disks_.balance();
    last_step_ = std::max(1L, std::lround(setup.max_time * setup.time_unit() / setup.time_step()));
    every_ = std::max(1L, last_step_ / setup.records);
    record();
  }

  void advance(long steps) override {
    try {
      for (; steps > 0 && !done_; --steps) {
        disks_.step(1);
        keep();
        const long now = disks_.implicit_tally().steps;
        if (now % every_ == 0) record();
        const bool rests =
            now % kJudgeSoftEvery == 0 && share() > 0.5 && disks_.rest().ratio < setup_.rest;
        if (!rests && now < last_step_) continue;
        if (now % every_ != 0) record();
        at_rest_ = rests;
        done_ = true;
      }
    } catch (const ComputationFailed& e) {
      throw ComputationFailed(fmt::format("{} (switch.step)", e.what()));
    }
  }
  bool done() const override { return done_; }
  Progress progress() const override {
    Progress p;
    p.phase = done_ ? "done" : fmt::format("rain, {:.0f} % soft", 100 * share());
    p.fraction = done_ ? 1 : static_cast<double>(disks_.implicit_tally().steps) / last_step_;
    p.simulated_time = disks_.time();
    p.steps = disks_.implicit_tally().steps;
    p.grains = p.awake = static_cast<int>(disks_.bodies().size());
    p.kinetic_energy = disks_.energy().kinetic;
    p.unbalanced_force_ratio = disks_.rest().ratio;
    return p;
  }
  RunResult result() const override {
    RunResult out;
    const ImplicitTally& t = disks_.implicit_tally();
    const SwitchTally& s = disks_.tally();
    const Snapshot pile = snapshot("pile");
    double most = 0, weight = 0;
    for (const SwitchRecord& r : records_) most = std::max(most, std::fabs(r[6]));
    for (const Grain& g : pile.grains) weight += g.mass * setup_.gravity;
    auto& f = out.figures;
    f["dem.grains"] = static_cast<double>(disks_.bodies().size());
    f["dem.contacts"] = static_cast<double>(pile.contacts.size());
    f["dem.steps"] = static_cast<double>(t.steps);
    f["dem.time_step"] = setup_.time_step();
    f["dem.unbalanced_force_ratio"] = disks_.rest().ratio;
    double carried = 0;
    for (const Wall& w : pile.walls) carried -= w.force.y();
    f["base.weight_ratio"] = carried / weight;
    f["switch.at_rest"] = at_rest_ ? 1 : 0;
    f["switch.time"] = disks_.time() / setup_.time_unit();
    f["switch.soft_share"] = share();
    f["switch.collisions"] = static_cast<double>(s.collisions);
    f["switch.to_soft"] = static_cast<double>(s.to_soft);
    f["switch.to_hard"] = static_cast<double>(s.to_hard);
    f["switch.pressed"] = static_cast<double>(s.pressed);
    f["switch.lost_impulses"] = s.lost / unit();
    f["switch.lost_soft"] = disks_.losses().total() / unit();
    f["switch.switched"] = s.switched / unit();
    f["switch.balance_error"] = most;
    f["switch.iterations"] = static_cast<double>(t.iterations) / static_cast<double>(t.solves);
    f["switch.halved"] = static_cast<double>(t.halved);
    for (std::size_t k = 0; k < kShown.size(); ++k) {
      if (shown_[k]) out.snapshots.emplace_back(fmt::format("soft_{}", kShown[k]), *shown_[k]);
    }
    out.snapshots.emplace_back("pile", pile);
    return out;
  }

 private:
  double unit() const { return setup_.weight() * 2 * setup_.radius; }
  double share() const {
    const std::vector<char>& soft = disks_.soft();
    return std::accumulate(soft.begin(), soft.end(), 0.0) / static_cast<double>(soft.size());
  }
  /// The state when that share is soft for the first time.
  void keep() {
    for (std::size_t k = 0; k < kShown.size(); ++k) {
      if (shown_[k] || 100 * share() < kShown[k]) continue;
      shown_[k] = snapshot(fmt::format("soft_{}", kShown[k]));
    }
  }
  void record() {
    const SoftEnergy e = disks_.energy();
    records_.push_back({disks_.time() / setup_.time_unit(), share(), e.kinetic / unit(),
                        (e.elastic + e.springs) / unit(), disks_.tally().lost / unit(),
                        disks_.losses().total() / unit(), (disks_.balance() - start_) / unit()});
  }

  Snapshot snapshot(const std::string& state) const {
    Snapshot out;
    out.time = disks_.time();
    out.gravity = {0, -setup_.gravity, 0};
    out.grains = grains_of(disks_.bodies(), disks_.angles());
    const std::vector<char>& soft = disks_.soft();
    const double half = 0.5 * setup_.width();
    const auto wall = [](const char* name, const Vec3& point, const Vec3& normal) {
      Wall w;
      w.name = name;
      w.point = point;
      w.normal = normal;
      return w;
    };
    out.walls = {wall("floor", {0, 0, 0}, {0, 1, 0}), wall("left", {-half, 0, 0}, {1, 0, 0}),
                 wall("right", {half, 0, 0}, {-1, 0, 0})};
    for (const SoftTouch& t : disks_.touches()) {
      Contact c = contact_of(t, out.grains);
      c.friction = setup_.coulomb;
      if (t.j < 0) out.walls[static_cast<std::size_t>(-1 - t.j)].force -= c.force;
      out.contacts.push_back(c);
    }
    out.attributes["state"] = state;
    out.attributes["seed"] = fmt::format("{}", seed_);
    out.attributes["packing"] = "rain";
    out.tables["soft"] = {{"grains", "1", {soft.begin(), soft.end()}}};
    keep_columns("switch", kSwitchColumns, records_, out);
    return out;
  }

  std::string fingerprint() const override {
    return fmt::format("hard to soft {} {}", fingerprint_of(setup_), seed_);
  }
  void visit(Archive& archive) override {
    std::string checkpoint = archive.is_reading() ? std::string() : disks_.checkpoint();
    archive(checkpoint);
    archive(records_);
    archive(at_rest_);
    archive(done_);
    for (std::size_t k = 0; k < kShown.size(); ++k) {
      archive.snapshot(shown_[k], fmt::format("soft_{}", kShown[k]));
    }
    archive.require(!records_.empty());
    if (archive.is_reading()) disks_.restore(checkpoint);
  }

  HardToSoftSetup setup_;
  std::uint64_t seed_;
  SwitchingDisks disks_;
  double start_ = 0;  // energy, J
  long last_step_ = 1, every_ = 1;
  std::vector<SwitchRecord> records_;
  std::array<std::optional<Snapshot>, kShown.size()> shown_;
  bool at_rest_ = false, done_ = false;
};

}  // namespace

std::unique_ptr<Run> make_hard_to_soft_run(const HardToSoftSetup& setup, std::uint64_t seed) {
  return std::make_unique<HardToSoftRun>(setup, seed);
}

Outlook foresee_hard_to_soft(const HardToSoftSetup& setup) {
  Outlook out;
  out.grains = static_cast<double>(setup.columns) * setup.rows;
  out.bytes = kBytesOfSwitchingDisk * out.grains;
  out.bytes_key = "switch.rows";
  out.time_step = setup.time_step();
  return out;
}

}  // namespace grainfield::dem
