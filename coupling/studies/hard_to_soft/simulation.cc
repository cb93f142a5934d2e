#include "coupling/studies/hard_to_soft/simulation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "dem/random/random.h"
#include "dem/run/soft_run.h"
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
double HardToSoftSetup::width() const {
  return drops() ? 2 * radius * floor : 2.2 * radius * (1 + polydispersity) * columns;
}
double HardToSoftSetup::longest_time() const {
  return ((drops() ? grains * interval : 0) + max_time) * time_unit();
}
double HardToSoftSetup::drop_time() const { return drops() ? grains * interval * time_unit() : 0; }

namespace {

constexpr double kBytesOfSwitchingDisk = 9000;
constexpr std::array<int, 3> kShown{25, 50, 75};  // %
constexpr double kEntry = 0.5;                    // diameters

// The column of the energies' sum.
constexpr std::size_t kSumOfEnergies = 6;

SwitchScene switch_scene(const HardToSoftSetup& s) {
  SwitchScene out;
  SoftLaw law;
  law.stiffness = s.stiffness();
  law.damping = s.damping * std::sqrt(s.mass() * s.stiffness());
  if (s.friction == "coulomb") {
    law.friction = SoftFriction::coulomb;
    law.coulomb = s.coulomb;
    law.tangential_stiffness = s.tangential_ratio * s.stiffness();
  } else {
    law.slip_damping = s.slip_damping * std::sqrt(s.mass() * s.stiffness());
    law.rolling_friction = s.rolling_friction;
  }
  out.soft.grains = law;
  out.soft.gravity = {0, -s.gravity};
  const double half = 0.5 * s.width();
  SoftLaw ground = law;
  ground.static_friction = s.static_friction;
  ground.well = s.well * 2 * s.radius;
  ground.renewed = true;
  out.soft.walls = {{{0, 0}, {0, 1}, ground}, {{-half, 0}, {1, 0}, law}, {{half, 0}, {-1, 0}, law}};
  out.grains = {s.restitution, s.impact_friction};
  out.walls.assign(3, out.grains);
  // Strays are caught.
  if (s.drops()) out.walls[1].restitution = out.walls[2].restitution = 0;
  return out;
}

Body<2> disk_of(const HardToSoftSetup& s, double radius) {
  Body<2> b;
  b.radius = radius;
  const double mass = s.density * std::numbers::pi * radius * radius;
  b.inverse_mass = 1 / mass;
  b.inverse_inertia = 2 / (mass * radius * radius);
  return b;
}

// The disks of a drop at y = 0.
std::vector<Body<2>> drop_of(const HardToSoftSetup& s, std::uint64_t seed) {
  Random random(seed);
  std::vector<Body<2>> out;
  for (int k = 0; k < s.grains; ++k) {
    Body<2> b = disk_of(s, s.radius * (1 + s.polydispersity * random.uniform(-1, 1)));
    b.position.x() = s.spread * s.radius * random.uniform(-1, 1);
    out.push_back(b);
  }
  return out;
}

// A disk that has fallen from `above` the height of the pile to kEntry diameters above it: nothing
// touches it on the way.
Body<2> falling(const HardToSoftSetup& s, Body<2> disk, double top) {
  const double fall = std::max(s.above - kEntry, 0.0) * 2 * s.radius;
  disk.position.y() = top + 2 * s.radius * s.above - fall + disk.radius;
  disk.velocity.y() = -std::sqrt(2 * s.gravity * fall);
  return disk;
}

// Row above row, each disk in a cell of its own.
std::vector<Body<2>> rain_of(const HardToSoftSetup& s, std::uint64_t seed) {
  Random random(seed);
  const double largest = s.radius * (1 + s.polydispersity), cell = s.width() / s.columns;
  std::vector<Body<2>> out;
  for (int j = 0; j < s.rows; ++j) {
    for (int i = 0; i < s.columns; ++i) {
      Body<2> b = disk_of(s, s.radius * (1 + s.polydispersity * random.uniform(-1, 1)));
      const double room = 0.5 * cell - b.radius;
      b.position = {-0.5 * s.width() + (i + 0.5) * cell + 0.9 * room * random.uniform(-1, 1),
                    largest + (j + 1) * 2 * s.radius * s.clearance + j * 2 * largest};
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

using SwitchBase = SoftRun<HardToSoftSetup, SwitchingDisks, std::size(kSwitchColumns)>;

class HardToSoftRun final : public SwitchBase {
 public:
  HardToSoftRun(const HardToSoftSetup& setup, std::uint64_t seed)
      : SoftRun(setup, seed, {switch_scene(setup), first_of(setup, seed), switch_steps(setup)},
                "switch.step") {
    if (setup.drops()) drop_ = drop_of(setup, seed);
    start_ = disks_.balance();
    record();
  }

  RunResult result() const override {
    RunResult out;
    const SwitchTally& s = disks_.tally();
    const Snapshot pile = snapshot("pile");
    double carried = 0, weight = 0;
    for (const Grain& g : pile.grains) weight += g.mass * setup_.gravity;
    for (const Wall& w : pile.walls) carried -= w.force.y();
    auto& f = out.figures;
    add_soft_figures("switch", pile, kSumOfEnergies, f);
    f["base.weight_ratio"] = carried / weight;
    f["switch.soft_share"] = share();
    f["switch.collisions"] = static_cast<double>(s.collisions);
    f["switch.to_soft"] = static_cast<double>(s.to_soft);
    f["switch.to_hard"] = static_cast<double>(s.to_hard);
    f["switch.pressed"] = static_cast<double>(s.pressed);
    f["switch.lost_impulses"] = s.lost / unit();
    f["switch.lost_soft"] = disks_.losses().total() / unit();
    f["switch.switched"] = s.switched / unit();
    for (std::size_t k = 0; k < kShown.size(); ++k) {
      if (shown_[k]) out.snapshots.emplace_back(fmt::format("soft_{}", kShown[k]), *shown_[k]);
    }
    out.snapshots.emplace_back("pile", pile);
    return out;
  }

 private:
  static std::vector<Body<2>> first_of(const HardToSoftSetup& s, std::uint64_t seed) {
    if (!s.drops()) return rain_of(s, seed);
    return {falling(s, drop_of(s, seed).front(), 0)};
  }
  bool step() override {
    if (dropped() < drop_.size()) drop_next();
    disks_.step(1);
    if (!setup_.drops()) keep();
    return true;
  }
  std::size_t dropped() const { return disks_.bodies().size(); }
  /// The next disk, when it is time and its place is free.
  void drop_next() {
    const double due = static_cast<double>(dropped()) * setup_.interval * setup_.time_unit();
    if (disks_.time() < due) return;
    const Body<2> next = falling(setup_, drop_[dropped()], top());
    for (const Body<2>& b : disks_.bodies()) {
      if ((b.position - next.position).norm() < 1.01 * (b.radius + next.radius)) return;
    }
    const double before = disks_.balance();
    disks_.add(next);
    start_ += disks_.balance() - before;
  }
  /// The highest point of the disks that are soft, of the ground if there is none.
  double top() const {
    double out = 0;
    for (std::size_t k = 0; k < disks_.bodies().size(); ++k) {
      const Body<2>& b = disks_.bodies()[k];
      if (disks_.soft()[k]) out = std::max(out, b.position.y() + b.radius);
    }
    return out;
  }
  bool may_rest() const override { return share() > 0.5 && dropped() >= drop_.size(); }
  /// A step takes a time in proportion to the disks, whose number grows with the time.
  double work(double time) const override {
    const double last = setup_.drop_time();
    return time < last ? 0.5 * time * time / last : time - 0.5 * last;
  }
  const ImplicitTally& tally() const override { return disks_.implicit_tally(); }
  std::string phase() const override {
    const std::string soft = fmt::format("{:.0f} % soft", 100 * share());
    if (dropped() < drop_.size()) {
      return fmt::format("drop {}/{}, {}", dropped(), drop_.size(), soft);
    }
    return fmt::format("{}, {}", setup_.drops() ? "settle" : "rain", soft);
  }
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
  void record() override {
    const SoftEnergy e = disks_.energy();
    records_.push_back({disks_.time() / setup_.time_unit(), share(), e.kinetic / unit(),
                        (e.elastic + e.springs) / unit(), disks_.tally().lost / unit(),
                        disks_.losses().total() / unit(), (disks_.balance() - start_) / unit()});
  }

  Snapshot snapshot(const std::string& state) const {
    Snapshot out = bare_snapshot(state, setup_.source);
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
      c.friction = setup_.friction == "coulomb" ? setup_.coulomb : 0;
      if (t.j == -1) c.friction += setup_.static_friction;
      if (t.j < 0) out.walls[static_cast<std::size_t>(-1 - t.j)].force -= c.force;
      out.contacts.push_back(c);
    }
    out.tables["soft"] = {{"grains", "1", {soft.begin(), soft.end()}}};
    keep_columns("switch", kSwitchColumns, records_, out);
    return out;
  }

  std::string fingerprint() const override {
    return fmt::format("hard to soft {} {}", fingerprint_of(setup_), seed_);
  }
  void visit(Archive& archive) override {
    std::int64_t count = static_cast<std::int64_t>(dropped());
    archive(count);
    archive.require(count >= 1 && (!setup_.drops() || count <= setup_.grains));
    while (archive.is_reading() && setup_.drops() && dropped() < static_cast<std::size_t>(count)) {
      // Somewhere: the checkpoint knows where.
      disks_.add(falling(setup_, drop_[dropped()], 4.0 * setup_.radius * dropped()));
    }
    archive(start_);
    visit_disks(archive);
    visit_end(archive);
    for (std::size_t k = 0; k < kShown.size(); ++k) {
      archive.snapshot(shown_[k], fmt::format("soft_{}", kShown[k]));
    }
  }

  std::vector<Body<2>> drop_;  // those of a drop, at y = 0
  double start_ = 0;           // energy of the disks as they came, J
  std::array<std::optional<Snapshot>, kShown.size()> shown_;
};

}  // namespace

std::unique_ptr<Run> make_hard_to_soft_run(const HardToSoftSetup& setup, std::uint64_t seed) {
  return std::make_unique<HardToSoftRun>(setup, seed);
}

Outlook foresee_hard_to_soft(const HardToSoftSetup& setup) {
  Outlook out;
  out.grains = setup.disks();
  out.bytes = kBytesOfSwitchingDisk * out.grains;
  out.bytes_key = setup.drops() ? "switch.grains" : "switch.rows";
  out.time_step = setup.time_step();
  return out;
}

}  // namespace grainfield::dem
