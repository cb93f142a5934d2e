#include "coupling/studies/implicit_settling/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "continuum/closed/liffman.h"
#include "dem/implicit/soft_disks.h"
#include "dem/laws/contact.h"
#include "dem/run/soft_run.h"
#include "dem/snapshot/contact_changes.h"

namespace grainfield::dem {

double ImplicitSettlingSetup::mass() const {
  return density * std::numbers::pi * lattice.radius * lattice.radius;
}
double ImplicitSettlingSetup::weight() const { return mass() * gravity; }
double ImplicitSettlingSetup::stiffness() const {
  return weight() / (softness * 2 * lattice.radius);
}
double ImplicitSettlingSetup::time_step() const {
  return step * 0.1 * std::numbers::pi * std::sqrt(mass() / stiffness());
}
double ImplicitSettlingSetup::time_unit() const { return std::sqrt(2 * lattice.radius / gravity); }

namespace {

// Bytes of a disk with its contacts and their part of the factors, about.
constexpr double kBytesOfSoftDisk = 8000;
// A contact whose normal rises less than this is one of a row.
constexpr double kRise = 0.5;

// Columns.
constexpr std::size_t kUnbalanced = 7, kSpread = 9;

SoftScene settling_scene(const ImplicitSettlingSetup& s) {
  const double dashpot = std::sqrt(s.mass() * s.stiffness());
  SoftScene out;
  out.gravity = {0, -s.gravity};
  out.grains.stiffness = s.stiffness();
  out.grains.damping = s.damping * dashpot;
  if (s.friction != "none") {
    out.grains.friction = s.friction == "viscous" ? SoftFriction::viscous : SoftFriction::coulomb;
    out.grains.slip_damping = s.slip_damping * dashpot;
    out.grains.rolling_friction = s.rolling_friction;
    out.grains.coulomb = s.coulomb;
    out.grains.tangential_stiffness = s.tangential_ratio * s.stiffness();
  }
  SoftLaw floor = out.grains;
  floor.static_friction = s.static_friction;
  floor.well = s.well * 2 * s.lattice.radius;
  out.walls = {{{0, 0}, {0, 1}, floor}};
  return out;
}

std::vector<Body<2>> settling_disks(const ImplicitSettlingSetup& s) {
  std::vector<Body<2>> out;
  for (const NewGrain& g : lattice_pile_grains(s.lattice, s.density)) {
    Body<2> b;
    b.position = {g.x, g.y};
    b.radius = g.radius;
    b.inverse_mass = 1 / s.mass();
    if (g.rotates || s.base_spins) b.inverse_inertia = 2 * b.inverse_mass / (g.radius * g.radius);
    out.push_back(b);
  }
  return out;
}

ImplicitSettings settling_steps(const ImplicitSettlingSetup& s) {
  ImplicitSettings out;
  out.scheme = s.scheme == "bdf2" ? ImplicitScheme::bdf2 : ImplicitScheme::conserving;
  out.time_step = s.time_step();
  out.relaxation = s.relaxation;
  out.tolerance = s.tolerance;
  out.max_iterations = s.max_iterations;
  return out;
}

using SettlingBase = SoftRun<ImplicitSettlingSetup, SoftDisks, std::size(kSettlingColumns)>;

class ImplicitSettlingRun final : public SettlingBase {
 public:
  ImplicitSettlingRun(const ImplicitSettlingSetup& setup, std::uint64_t seed)
      : SoftRun(setup, seed, {settling_scene(setup), settling_disks(setup), settling_steps(setup)},
                "settling.step, settling.max_iterations") {
    start_ = disks_.energy().total();
    base_ = setup.lattice.base_grains;
    hard_ = continuum::lattice_base_forces(lattice_rows(setup.lattice), setup.weight(),
                                           1 / std::numbers::sqrt3);
    record();
  }

  RunResult result() const override {
    RunResult out;
    const Snapshot pile = snapshot();
    auto& f = out.figures;
    add_soft_figures("settling", pile, kUnbalanced, f);
    f["base.weight_ratio"] =
        base_force(pile).y() / (static_cast<double>(disks_.bodies().size()) * setup_.weight());
    f["settling.most_iterations"] = tally().most_iterations;
    f["settling.spread"] = records_.back()[kSpread];
    f["settling.spread_speed"] = at_rest_ ? 0 : last_speed();
    double rows = 0;
    for (const Contact& c : pile.contacts) rows += c.j >= 0 && std::fabs(c.normal.y()) < kRise;
    f["settling.row_contacts"] = rows;
    out.snapshots = {{"pile", pile}};
    return out;
  }

 private:
  // A step that is halved again and again counts by its parts, so that advance() returns in time.
  bool step() override { return disks_.try_part(); }
  const ImplicitTally& tally() const override { return disks_.tally(); }
  std::string phase() const override { return "settle"; }
  double unit() const { return setup_.weight() * 2 * setup_.lattice.radius; }
  void record() override {
    const SoftEnergy e = disks_.energy();
    const SoftLosses& lost = disks_.losses();
    const ImplicitTally& t = disks_.tally();
    const long solves = t.solves - solves_;
    const auto [normal, horizontal] = errors();
    const double width = disks_.bodies()[base_ - 1].position.x() - disks_.bodies()[0].position.x();
    records_.push_back(
        {disks_.time() / setup_.time_unit(), e.kinetic / unit(), (e.elastic + e.springs) / unit(),
         lost.normal / unit(), lost.tangential / unit(), lost.well / unit(), lost.scheme / unit(),
         (e.total() + lost.total() - start_) / unit(),
         solves > 0 ? static_cast<double>(t.iterations - iterations_) / solves : 0,
         (width - (base_ - 1) * lattice_spacing(setup_.lattice)) / (2 * setup_.lattice.radius),
         normal, horizontal});
    solves_ = t.solves;
    iterations_ = t.iterations;
  }
  /// Largest differences of the base disks' N and H from those of hard disks, over the largest.
  std::pair<double, double> errors() const {
    std::vector<continuum::BaseForce> off(hard_.size());
    for (const SoftTouch& t : disks_.touches()) {
      if (t.j >= 0 || t.i >= base_) continue;
      off[t.i].normal += t.repulsion;
      off[t.i].horizontal -= t.tangential;
    }
    continuum::BaseForce away, largest;
    for (std::size_t k = 0; k < hard_.size(); ++k) {
      away.normal = std::max(away.normal, std::fabs(off[k].normal - hard_[k].normal));
      away.horizontal =
          std::max(away.horizontal, std::fabs(off[k].horizontal - hard_[k].horizontal));
      largest.normal = std::max(largest.normal, hard_[k].normal);
      largest.horizontal = std::max(largest.horizontal, std::fabs(hard_[k].horizontal));
    }
    return {away.normal / largest.normal, away.horizontal / largest.horizontal};
  }
  /// d/sqrt(d/g), of the last tenth of the records.
  double last_speed() const {
    const std::size_t n = records_.size(), from = n - 1 - std::max<std::size_t>(1, n / 10);
    const auto &a = records_[n > 1 ? from : 0], &b = records_.back();
    return b[0] > a[0] ? (b[kSpread] - a[kSpread]) / (b[0] - a[0]) : 0;
  }

  Snapshot snapshot() const {
    Snapshot out = bare_snapshot("pile", "lattice");
    Wall floor;
    floor.name = "floor";
    for (const SoftTouch& t : disks_.touches()) {
      Contact c = contact_of(t, out.grains);
      // What they hold at most at rest: the ground's wells beside Coulomb's friction.
      c.friction = setup_.friction == "coulomb" ? setup_.coulomb : 0;
      if (t.j < 0) c.friction += setup_.static_friction;
      c.sliding = c.friction > 0 &&
                  std::fabs(t.tangential) >= c.friction * t.repulsion * (1 - kSlidingMargin);
      if (t.j < 0) floor.force -= c.force;
      out.contacts.push_back(c);
    }
    out.walls = {floor};
    keep_columns("settling", kSettlingColumns, records_, out);
    return out;
  }

  std::string fingerprint() const override {
    return fmt::format("implicit settling {} {}", fingerprint_of(setup_), seed_);
  }
  void visit(Archive& archive) override {
    visit_disks(archive);
    archive(solves_);
    archive(iterations_);
    visit_end(archive);
  }

  double start_ = 0;  // energy, J
  int base_ = 0;
  std::vector<continuum::BaseForce> hard_;  // of the base disks, N
  long solves_ = 0, iterations_ = 0;        // at the last record
};

void check_settling(const ImplicitSettlingSetup& s) {
  check_lattice(s.lattice);
  if (s.static_friction > 0 && !(s.well > 0)) {
    throw std::invalid_argument(
        fmt::format("settling.well: found {:g} with settling.static_friction {:g}, allowed: above "
                    "0",
                    s.well, s.static_friction));
  }
}

}  // namespace

std::unique_ptr<Run> make_implicit_settling_run(const ImplicitSettlingSetup& setup,
                                                std::uint64_t seed) {
  check_settling(setup);
  return std::make_unique<ImplicitSettlingRun>(setup, seed);
}

Outlook foresee_implicit_settling(const ImplicitSettlingSetup& setup) {
  check_settling(setup);
  Outlook out;
  for (const int row : lattice_rows(setup.lattice)) out.grains += row;
  out.bytes = kBytesOfSoftDisk * out.grains;
  out.bytes_key = "lattice.base_grains";
  out.time_step = setup.time_step();
  return out;
}

}  // namespace grainfield::dem
