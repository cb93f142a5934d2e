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
double HardToSoftSetup::width() const { return 2.2 * radius * (1 + polydispersity) * columns; }

namespace {

constexpr double kBytesOfSwitchingDisk = 9000;
constexpr std::array<int, 3> kShown{25, 50, 75};  // %

// The column of the energies' sum.
constexpr std::size_t kSumOfEnergies = 6;

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

using SwitchBase = SoftRun<HardToSoftSetup, SwitchingDisks, std::size(kSwitchColumns)>;

class HardToSoftRun final : public SwitchBase {
 public:
  HardToSoftRun(const HardToSoftSetup& setup, std::uint64_t seed)
      : SoftRun(setup, seed, {switch_scene(setup), rain_of(setup, seed), switch_steps(setup)},
                "switch.step") {
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
  bool step() override {
    disks_.step(1);
    keep();
    return true;
  }
  bool may_rest() const override { return share() > 0.5; }
  const ImplicitTally& tally() const override { return disks_.implicit_tally(); }
  std::string phase() const override { return fmt::format("rain, {:.0f} % soft", 100 * share()); }
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
    Snapshot out = bare_snapshot(state, "rain");
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
    out.tables["soft"] = {{"grains", "1", {soft.begin(), soft.end()}}};
    keep_columns("switch", kSwitchColumns, records_, out);
    return out;
  }

  std::string fingerprint() const override {
    return fmt::format("hard to soft {} {}", fingerprint_of(setup_), seed_);
  }
  void visit(Archive& archive) override {
    visit_disks(archive);
    visit_end(archive);
    for (std::size_t k = 0; k < kShown.size(); ++k) {
      archive.snapshot(shown_[k], fmt::format("soft_{}", kShown[k]));
    }
  }

  double start_ = 0;  // energy, J
  std::array<std::optional<Snapshot>, kShown.size()> shown_;
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
