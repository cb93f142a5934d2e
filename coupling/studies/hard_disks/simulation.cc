#include "coupling/studies/hard_disks/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/collisions/gas.h"
#include "dem/collisions/hard_engine.h"
#include "dem/run/archive.h"
#include "dem/run/fingerprint.h"
#include "dem/space/elementary.h"

namespace grainfield::dem {
namespace {

// Bytes of a grain with its plans, entries of the heap and cells, about. Snapshots come beside it.
constexpr double kBytesPerGrain = 500;
// The box's side over the radius, at least: no pair meets by two images.
constexpr double kLeastSide = 6.01;

template <int D>
GasSetup gas_of(const HardParticlesSetup& s, double fraction) {
  GasSetup out;
  out.grains = s.grains;
  out.fraction = fraction;
  out.radius = s.radius;
  out.mass = s.density * round_volume<D>(s.radius);
  out.speed = s.speed;
  return out;
}

struct CoolingRecord {
  double time = 0, temperature = 0, spin_temperature = 0, collisions = 0;
};

template <int D>
class HardParticlesRun final : public ArchivedRun {
 public:
  HardParticlesRun(const HardParticlesSetup& setup, std::uint64_t seed)
      : setup_(setup), seed_(seed), random_(seed) {
    begin();
  }

  void advance(long steps) override {
    try {
      while (steps > 0 && !done()) steps -= go_on(steps);
    } catch (const ComputationFailed& e) {
      throw ComputationFailed(fmt::format("{} (gas.contact_time, gas.restitution)", e.what()));
    }
  }
  bool done() const override { return at_ == setup_.fractions.size(); }
  Progress progress() const override {
    Progress p;
    const double n = static_cast<double>(setup_.fractions.size());
    p.phase = done() ? "done"
                     : fmt::format("{} {}, fraction {:g}", mixed_ ? "measure" : "mix", setup_.shape,
                                   setup_.fractions[at_]);
    p.fraction = (static_cast<double>(at_) + share()) / n;
    p.simulated_time = engine_->time();
    p.steps = steps_;
    p.grains = p.awake = setup_.grains;
    p.kinetic_energy = engine_->kinetic_energy();
    return p;
  }
  RunResult result() const override {
    RunResult out;
    out.figures = figures_;
    out.figures["dem.grains"] = setup_.grains;
    out.figures["gas.events"] = static_cast<double>(steps_);
    for (std::size_t k = 0; k < snapshots_.size(); ++k) {
      out.snapshots.emplace_back(name_of_fraction(setup_.fractions[k]), *snapshots_[k]);
    }
    return out;
  }

 private:
  bool cools() const { return setup_.kind == "cooling"; }
  GasSetup gas() const { return gas_of<D>(setup_, setup_.fractions[at_]); }
  double grains() const { return static_cast<double>(setup_.grains); }
  /// Collisions of pairs that make so many a grain.
  long pairs_of(double collisions) const {
    return static_cast<long>(std::ceil(0.5 * collisions * grains()));
  }

  /// The next fraction from its lattice.
  void begin() {
    mixed_ = false;
    first_.clear();
    records_.clear();
    engine_ = engine_of(start_gas<D>(gas(), random_));
    energy_ = engine_->kinetic_energy();
  }
  /// Engine of grains, which lose energy when they are mixed and are to cool.
  std::unique_ptr<HardEngine<D>> engine_of(const std::vector<Body<D>>& grains) const {
    HardScene<D> scene;
    scene.box = gas_box<D>(gas());
    if (mixed_ && cools()) {
      scene.grains = {setup_.restitution, setup_.friction};
      scene.contact_time = setup_.contact_time;
    }
    return std::make_unique<HardEngine<D>>(scene, grains);
  }
  std::vector<Body<D>> bodies() const {
    std::vector<Body<D>> out;
    for (std::size_t k = 0; k < engine_->grains(); ++k) out.push_back(engine_->body(k));
    return out;
  }

  /// At most so many events; returns how many.
  long go_on(long steps) {
    const long before = engine_->tally().events;
    if (!mixed_ || !cools()) {
      // No event is more than one collision, so that none is missed.
      const long wanted = pairs_of(setup_.equilibration + (mixed_ ? setup_.collisions : 0));
      engine_->advance(std::min(steps, wanted - engine_->tally().pairs));
      count(engine_->tally().events - before);
      if (engine_->tally().pairs >= wanted) mixed_ ? finish() : start_measuring();
    } else {
      const double next = start_ + time_of(records_.size());
      const bool there = engine_->advance(steps, next) < steps;
      count(engine_->tally().events - before);
      if (there) record();
      if (records_.size() == static_cast<std::size_t>(setup_.records)) finish();
    }
    return std::max(last_, 1L);
  }
  void count(long events) {
    last_ = events;
    steps_ += events;
  }

  void start_measuring() {
    mixed_ = true;
    first_ = bodies();
    if (cools()) {
      engine_ = engine_of(first_);
      energy_ = engine_->kinetic_energy();
      record();
    }
    tally_ = engine_->tally();
    start_ = engine_->time();
  }

  // -- cooling

  double enskog() const {
    const double f = setup_.fractions[at_];
    return enskog_rate<D>(f, setup_.radius, setup_.speed, gas_compressibility<D>(f));
  }
  double haff() const { return haff_time<D>(enskog(), setup_.restitution); }
  /// Time of a record since the start, s: even steps of ln(1 + t/tau).
  double time_of(std::size_t record) const {
    const double share =
        static_cast<double>(record) / static_cast<double>(std::max(setup_.records - 1, 1));
    const double whole = -0.5 * natural_log(setup_.cool_to);  // ln(1 + t/tau) at the end
    return haff() * (exponential(share * whole) - 1);
  }
  void record() {
    const std::vector<Body<D>> now = bodies();
    const double unit = gas().mass * setup_.speed * setup_.speed;
    records_.push_back({time_of(records_.size()) / haff(), temperature_of(now) / unit,
                        spin_temperature_of(now) / unit,
                        2 * static_cast<double>(engine_->tally().pairs) / grains()});
  }

  // -- figures

  double share() const {
    if (done()) return 0;
    const double pairs = static_cast<double>(engine_->tally().pairs);
    if (mixed_ && cools()) {
      return 0.5 + 0.5 * static_cast<double>(records_.size()) / setup_.records;
    }
    const double whole = setup_.equilibration + (cools() ? 0 : setup_.collisions);
    return (cools() ? 0.5 : 1) * std::min(1.0, 2 * pairs / (grains() * whole));
  }
  void finish() {
    const double f = setup_.fractions[at_];
    const std::string name = "gas." + name_of_fraction(f) + ".";
    const HardTally& now = engine_->tally();
    figures_[name + "overlap"] = now.deepest;
    figures_[name + "collisions"] = static_cast<double>(now.pairs);
    figures_[name + "elastic_share"] =
        static_cast<double>(now.elastic) / static_cast<double>(now.pairs);
    if (cools()) {
      const double seen = records_.back().temperature;
      figures_[name + "temperature"] = seen;
      const double lost = engine_->kinetic_energy() + engine_->lost();
      figures_[name + "energy_drift"] = std::fabs(lost / energy_ - 1);
      if (setup_.friction == 0) {
        figures_[name + "temperature_over_haff"] = seen / setup_.cool_to;
      }
    } else {
      add_gas_figures(name, f);
    }
    snapshots_.push_back(snapshot());
    ++at_;
    if (!done()) begin();
  }
  void add_gas_figures(const std::string& name, double f) {
    const HardTally& now = engine_->tally();
    const double time = engine_->time() - start_, mass = gas().mass;
    const double energy = engine_->kinetic_energy();
    // Without spins all energy is that of the motion: p V = (2 K + virial/t)/D, n k T = 2 K/D.
    const double z = 1 + (now.virial - tally_.virial) / (time * 2 * energy);
    const double theory = gas_compressibility<D>(f);
    const double pairs = static_cast<double>(now.pairs - tally_.pairs);
    const double rate = 2 * pairs / (grains() * time);
    const double speed = std::sqrt(temperature_of(bodies()) / mass);
    figures_[name + "compressibility"] = z;
    figures_[name + "theory"] = theory;
    figures_[name + "compressibility_over_theory"] = z / theory;
    figures_[name + "compressibility_over_virial_series"] = z / gas_virial_series<D>(f);
    figures_[name + "collision_rate"] = rate;
    figures_[name + "collision_rate_over_enskog"] =
        rate / enskog_rate<D>(f, setup_.radius, speed, theory);
    figures_[name + "energy_drift"] = std::fabs(energy / energy_ - 1);
  }
  Snapshot snapshot() const {
    Snapshot out;
    out.dim = D;
    out.time = engine_->time();
    const HardBox<D> box = gas_box<D>(gas());
    for (int a = 0; a < D; ++a) {
      out.cell.periodic[static_cast<std::size_t>(a)] = true;
      out.cell.edges(a, a) = box.size[a];
    }
    const std::vector<Body<D>> now = bodies();
    for (std::size_t k = 0; k < now.size(); ++k) {
      Grain g;
      g.id = static_cast<std::int64_t>(k);
      g.position = to_three(now[k].position);
      g.velocity = to_three(now[k].velocity);
      g.radius = now[k].radius;
      g.mass = 1 / now[k].inverse_mass;
      g.inertia = 1 / now[k].inverse_inertia;
      g.volume = round_volume<D>(g.radius);
      if constexpr (D == 2) {
        g.spin = now[k].spin;
      } else {
        g.spin = now[k].spin.z();
        g.angular_velocity = now[k].spin;
        g.moments.setConstant(g.inertia);
      }
      out.grains.push_back(g);
    }
    out.attributes["state"] = name_of_fraction(setup_.fractions[at_]);
    out.attributes["seed"] = fmt::format("{}", seed_);
    if (!records_.empty()) add_columns(out);
    return out;
  }
  void add_columns(Snapshot& out) const {
    NumberTable& table = out.tables["gas"];
    for (const char* name : kCoolingColumns) table.push_back({name, "1", {}});
    for (const CoolingRecord& r : records_) {
      const double values[] = {r.time, r.temperature, r.spin_temperature, r.collisions};
      static_assert(std::size(values) == std::size(kCoolingColumns));
      for (std::size_t c = 0; c < table.size(); ++c) table[c].values.push_back(values[c]);
    }
  }

  // -- checkpoints

  std::string fingerprint() const override {
    return fmt::format("hard disks {} {}", fingerprint_of(setup_), seed_);
  }
  void visit(Archive& archive) override {
    std::uint64_t at = at_, state = random_.state();
    archive(at);
    archive(state);
    archive.require(at <= setup_.fractions.size());
    at_ = at;
    random_.set_state(state);
    archive(mixed_);
    archive(first_);
    archive(records_);
    archive(steps_);
    archive(energy_);
    archive(start_);
    archive(tally_);
    archive(figures_);
    snapshots_.resize(at_);
    for (std::size_t k = 0; k < at_; ++k) {
      archive.snapshot(snapshots_[k], name_of_fraction(setup_.fractions[k]));
      archive.require(snapshots_[k].has_value());
    }
    // An engine of the same scene and as many grains takes the state's place.
    if (archive.is_reading() && !done()) {
      archive.require(!mixed_ || first_.size() == static_cast<std::size_t>(setup_.grains));
      Random any(seed_);
      engine_ = engine_of(mixed_ ? first_ : start_gas<D>(gas(), any));
    }
    if (!done()) {
      engine_->visit(archive);
      if (archive.is_reading()) archive.require(engine_->settle());
    }
  }
  HardParticlesSetup setup_;
  std::uint64_t seed_;
  Random random_;
  std::size_t at_ = 0;  // of the fractions
  bool mixed_ = false;
  std::vector<Body<D>> first_;  // when the grains were mixed
  std::unique_ptr<HardEngine<D>> engine_;
  HardTally tally_;                // then
  double energy_ = 0, start_ = 0;  // J of the lattice or when cooling began; s when mixed
  std::vector<CoolingRecord> records_;
  long steps_ = 0, last_ = 0;
  std::map<std::string, double> figures_;
  std::vector<std::optional<Snapshot>> snapshots_;
};

template <int D>
void check_fractions(const HardParticlesSetup& s) {
  const double most = largest_fraction<D>(s.grains, s.radius);
  for (const double f : s.fractions) {
    if (f <= most) continue;
    throw std::invalid_argument(fmt::format(
        "gas.fractions: found {:g}, which {} {}s in a {} cannot fill, allowed: at most {:.4f}, "
        "the densest lattice that fits into it",
        f, s.grains, s.shape, D == 2 ? "square" : "cube", std::floor(1e4 * most) / 1e4));
  }
  for (const double f : s.fractions) {
    const double side = gas_box<D>(gas_of<D>(s, f)).size[0], least = kLeastSide * s.radius;
    if (side > least) continue;
    throw std::invalid_argument(fmt::format(
        "gas.grains: found {}, at a fraction of {:g} in a box of {:.3g} m, allowed: more, for a "
        "box above {:.3g} m, {:g} radii",
        s.grains, f, side, least, kLeastSide));
  }
}

void check_hard_particles(const HardParticlesSetup& s) {
  if (s.kind == "cooling" && s.restitution == 1) {
    throw std::invalid_argument(
        "gas.restitution: found 1 with gas.kind \"cooling\", allowed: below 1");
  }
  s.is_3d() ? check_fractions<3>(s) : check_fractions<2>(s);
  if (s.kind == "cooling") {
    // A collision takes (1 - e^2)/(2 D) of the two grains' energy.
    const double each = 2 * (s.is_3d() ? 3 : 2) * std::log(1 / std::sqrt(s.cool_to)) /
                        (1 - s.restitution * s.restitution);
    const double all = 0.5 * s.grains * static_cast<double>(s.fractions.size()) * each;
    if (all > kMostSteps) {
      throw std::invalid_argument(fmt::format(
          "gas.restitution: found {:.12g}, about {:.3g} collisions until gas.cool_to = {:g}, "
          "allowed: at most {:.3g}; a smaller one, or fewer grains",
          s.restitution, all, s.cool_to, kMostSteps));
    }
  }
  const double gases = 0.5 * s.grains * static_cast<double>(s.fractions.size());
  for (const auto& [key, each] : {std::pair("gas.equilibration", s.equilibration),
                                  std::pair("gas.collisions", s.collisions)}) {
    if (gases * each <= kMostSteps) continue;
    throw std::invalid_argument(fmt::format(
        "{}: found {:g}, {:.3g} collisions in all, allowed: at most {:.3g} with so many grains",
        key, each, gases * each, std::floor(kMostSteps / gases)));
  }
}

}  // namespace

std::string name_of_fraction(double fraction) { return fmt::format("fraction_{:g}", fraction); }

std::unique_ptr<Run> make_hard_particles_run(const HardParticlesSetup& setup, std::uint64_t seed) {
  check_hard_particles(setup);
  if (setup.is_3d()) return std::make_unique<HardParticlesRun<3>>(setup, seed);
  return std::make_unique<HardParticlesRun<2>>(setup, seed);
}

Outlook foresee_hard_particles(const HardParticlesSetup& setup) {
  check_hard_particles(setup);
  Outlook out;
  out.grains = setup.grains;
  const double snapshots = static_cast<double>(setup.fractions.size() * sizeof(Grain));
  out.bytes = (kBytesPerGrain + snapshots) * out.grains;
  out.bytes_key = "gas.grains";
  return out;
}

}  // namespace grainfield::dem
