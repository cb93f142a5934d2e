// Disordered heaps settled by implicit motion and by the explicit engine: from the same starts and
// under the same laws grains of a heap lie elsewhere, and the ensembles are the same.
//
// The laws differ in how springs and dashpots share a contact that slides: the engine's spring is
// what Coulomb's limit leaves beside the dashpot, the implicit one has that limit alone. At rest
// there is no dashpot.
//
// Lengths are in d, masses in m (of a disk of diameter d), times in sqrt(d/g).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <complex>
#include <cstdio>
#include <memory>
#include <string>

#include "coupling/specimen/surface.h"
#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "tests/dem/implicit_scene.h"

namespace grainfield::dem::testing {
namespace {

constexpr int kHeaps = 64, kGrains = 100;
constexpr double kRest = 1e-5;     // forces balance to this share of the mean contact force
constexpr double kMostTime = 200;  // a heap that still moves then fails
constexpr double kDensity = 4 / std::numbers::pi;
// Small disks stand still in a row on the floor, so that heaps do not roll apart. The gaps let the
// smaller grains down to the floor itself.
constexpr double kBump = 0.2, kBumpSpacing = 1.2;
constexpr int kBumps = 51;
// Radii are kLeast + k kRung, k < kSizes: 0.5 within 30 %.
constexpr double kLeast = 0.35, kRung = 0.025;
constexpr int kSizes = 13;

double mass_of(double radius) { return 4 * radius * radius; }

/// Of any two disks and of a disk and the floor: m g/(K d) = 1e-3; two of mass m part at 0.4 of the
/// speed at which they meet. Nothing resists rolling.
struct Laws {
  double stiffness = 1000, tangential_stiffness = 2000.0 / 7;
  double damping = 0.4 * std::sqrt(1000), slip_damping = 0.1 * std::sqrt(1000);  // K_D, K_slip
  double friction = 0.5;
  double background_damping = 0.5;
};

struct Disk {
  double x = 0, y = 0, radius = 0;
  int size = -1;  // of kSizes; -1: it stands still
};

std::vector<Disk> bumps() {
  std::vector<Disk> out;
  for (int k = 0; k < kBumps; ++k) {
    out.push_back({kBumpSpacing * (k - kBumps / 2), 1.0001 * kBump, kBump});
  }
  return out;
}

bool is_free(const std::vector<Disk>& disks, const Disk& at) {
  return std::none_of(disks.begin(), disks.end(), [&](const Disk& d) {
    return std::hypot(d.x - at.x, d.y - at.y) < d.radius + at.radius;
  });
}

/// The row, and grains at random places in a triangle above it that do not touch.
std::vector<Disk> loose_triangle(std::uint64_t seed) {
  constexpr double kSide = 14;  // height and half width: two fifths of it are filled
  Random random(seed);
  std::vector<Disk> out = bumps();
  while (static_cast<int>(out.size()) < kBumps + kGrains) {
    Disk d;
    d.size = static_cast<int>(random.uniform(0, kSizes));
    d.radius = kLeast + kRung * d.size;
    do {
      d.x = random.uniform(-kSide, kSide);
      d.y = random.uniform(1, 1 + kSide);
    } while (d.y > 1 + kSide - std::fabs(d.x) || !is_free(out, d));
    out.push_back(d);
  }
  return out;
}

// -- The two movers ------------------------------------------------------------------------------

std::string material_of(int size) { return size < 0 ? "base" : "size " + std::to_string(size); }

/// The linear law takes its dashpots per effective mass; each pair of sizes has its own, so that
/// K_D and K_slip are those of Laws for all.
LinearLaw linear_law(const Laws& laws, double effective_mass) {
  return {laws.stiffness, laws.tangential_stiffness, laws.damping / effective_mass,
          laws.slip_damping / effective_mass};
}

EngineSettings engine_settings(const Laws& laws) {
  EngineSettings s;
  s.shape = ShapeKind::disk;
  s.gravity_y = -1;
  s.law = linear_law(laws, 0.5);
  for (int a = -1; a < kSizes; ++a) {
    s.materials.push_back(material_of(a));
    for (int b = std::max(a, 0); b < kSizes; ++b) {
      const double by_a = a < 0 ? 0 : 1 / mass_of(kLeast + kRung * a);
      const double by_b = 1 / mass_of(kLeast + kRung * b);
      s.material_pairs.push_back(
          {material_of(a), material_of(b), linear_law(laws, 1 / (by_a + by_b)), laws.friction});
    }
  }
  s.material_pairs.push_back(
      {material_of(-1), material_of(-1), linear_law(laws, 1), laws.friction});
  s.time_step = stable_time_step(s, mass_of(kLeast), kLeast);
  return s;
}

std::unique_ptr<Engine> engine_of(const Laws& laws, const std::vector<Disk>& start) {
  auto engine = make_engine(engine_settings(laws));
  Wall floor{"floor", {0, 0, 0}, {0, 1, 0}, laws.friction};
  floor.material = material_of(-1);
  engine->add_wall(floor);
  engine->set_background_damping(laws.background_damping);
  for (const Disk& d : start) {
    NewGrain g;
    g.x = d.x;
    g.y = d.y;
    g.radius = d.radius;
    g.density = kDensity;
    g.fixed = d.size < 0;
    g.material = material_of(d.size);
    engine->add(g);
  }
  return engine;
}

SoftScene soft_scene(const Laws& laws) {
  SoftScene out;
  out.gravity = {0, -1};
  out.background_damping = laws.background_damping;
  out.grains.stiffness = laws.stiffness;
  out.grains.damping = laws.damping;
  out.grains.friction = SoftFriction::coulomb;
  out.grains.slip_damping = laws.slip_damping;
  out.grains.coulomb = laws.friction;
  out.grains.tangential_stiffness = laws.tangential_stiffness;
  out.walls = {ground(out.grains)};
  return out;
}

SoftDisks soft_disks_of(const Laws& laws, const std::vector<Disk>& start) {
  std::vector<Body<2>> bodies;
  for (const Disk& d : start) {
    bodies.push_back(soft_disk(d.x, d.y, d.radius, mass_of(d.radius)));
    if (d.size < 0) bodies.back().inverse_mass = bodies.back().inverse_inertia = 0;
  }
  return {soft_scene(laws), bodies, steps_of(10 * engine_settings(laws).time_step)};
}

/// Grains and contacts as the engine's snapshot tells them.
Snapshot snapshot_of(const SoftDisks& disks) {
  Snapshot out;
  for (const Body<2>& b : disks.bodies()) {
    Grain g;
    g.position = Vec3(b.position.x(), b.position.y(), 0);
    g.radius = b.radius;
    g.mass = mass_of(b.radius);
    g.fixed = b.inverse_mass == 0;
    out.grains.push_back(g);
  }
  for (const SoftTouch& t : disks.touches()) {
    Contact c;
    c.i = t.i;
    c.j = t.j;
    c.normal_force = t.repulsion;
    c.force.x() = -t.repulsion * t.normal.x() - t.tangential * t.normal.y();
    c.force.y() = -t.repulsion * t.normal.y() + t.tangential * t.normal.x();
    out.contacts.push_back(c);
  }
  return out;
}

Snapshot settled_by_engine(const Laws& laws, const std::vector<Disk>& start) {
  const auto engine = engine_of(laws, start);
  double ratio = 1;
  while (ratio > kRest && engine->time() < kMostTime) {
    engine->step(200);
    ratio = engine->measure().unbalanced_force_ratio;
  }
  EXPECT_LE(ratio, kRest);
  return engine->snapshot();
}

Snapshot settled_implicitly(const Laws& laws, const std::vector<Disk>& start,
                            ImplicitTally& tally) {
  SoftDisks disks = soft_disks_of(laws, start);
  while (!(disks.rest().ratio <= kRest) && disks.time() < kMostTime) disks.step(20);
  EXPECT_LE(disks.rest().ratio, kRest);
  tally.steps += disks.tally().steps;
  tally.solves += disks.tally().solves;
  tally.iterations += disks.tally().iterations;
  tally.halved += disks.tally().halved;
  return snapshot_of(disks);
}

// -- What is measured ----------------------------------------------------------------------------

constexpr std::array kFigures = {"contacts a grain", "repose left, deg", "repose right, deg",
                                 "height, d",        "pressure, middle", "pressure, shoulders",
                                 "weight carried"};
enum Figure { kContacts, kLeft, kRight, kHeight, kMiddle, kShoulders, kCarried };
using Figures = std::array<double, kFigures.size()>;

double centre_of(const Snapshot& s) {
  double moment = 0, mass = 0;
  for (const Grain& g : s.grains) {
    if (g.fixed) continue;
    moment += g.mass * g.position.x();
    mass += g.mass;
  }
  return moment / mass;
}

/// A contact on the floor or its row, seen from the grain.
struct Foot {
  double x = 0, force = 0;  // upwards
};
std::vector<Foot> feet_of(const Snapshot& s) {
  std::vector<Foot> out;
  for (const Contact& c : s.contacts) {
    const Grain& i = s.grains[c.i];
    if (c.j < 0 && !i.fixed) {
      out.push_back({i.position.x(), c.force.y()});
    } else if (c.j >= 0 && i.fixed != s.grains[c.j].fixed) {
      const Grain& grain = i.fixed ? s.grains[c.j] : i;
      out.push_back({grain.position.x(), i.fixed ? -c.force.y() : c.force.y()});
    }
  }
  return out;
}

/// Pressures are of the base within 3 d of the centre of mass, and from there to 9 d on both sides,
/// in m g/d.
Figures figures_of(const Snapshot& s) {
  constexpr double kInner = 3, kOuter = 9, kColumn = 0.5;
  Figures out{};
  double weight = 0, ends = 0;
  for (const Grain& g : s.grains) weight += g.fixed ? 0 : g.mass;
  for (const Contact& c : s.contacts) {
    ends += !s.grains[c.i].fixed;
    ends += c.j >= 0 && !s.grains[c.j].fixed;
  }
  out[kContacts] = ends / kGrains;
  const coupling::HeapShape shape = coupling::measure_heap(coupling::free_surface(s, kColumn));
  out[kLeft] = shape.repose_left_deg;
  out[kRight] = shape.repose_right_deg;
  out[kHeight] = shape.height;
  const double centre = centre_of(s);
  for (const Foot& foot : feet_of(s)) {
    const double away = std::fabs(foot.x - centre);
    if (away < kInner) out[kMiddle] += foot.force / (2 * kInner);
    if (away >= kInner && away < kOuter) out[kShoulders] += foot.force / (2 * (kOuter - kInner));
    out[kCarried] += foot.force / weight;
  }
  return out;
}

struct Mean {
  double value = 0, error = 0;
  /// Of a difference, in its standard errors.
  double away() const { return std::fabs(value) / error; }
};
/// Of kHeaps values, with the standard error by their spread.
template <class Of>
Mean mean_of(Of of) {
  Mean out;
  for (int k = 0; k < kHeaps; ++k) out.value += of(k) / kHeaps;
  double squares = 0;
  for (int k = 0; k < kHeaps; ++k) squares += std::pow(of(k) - out.value, 2);
  out.error = std::sqrt(squares / (kHeaps - 1) / kHeaps);
  return out;
}

using Ensemble = std::vector<Figures>;
Mean mean_of(const Ensemble& of, std::size_t figure) {
  return mean_of([&](int k) { return of[k][figure]; });
}
Mean difference(const Ensemble& a, const Ensemble& b, std::size_t figure) {
  return mean_of([&](int k) { return a[k][figure] - b[k][figure]; });
}

/// How far grains of the same number are apart: root of the mean square, d.
double apart(const Snapshot& a, const Snapshot& b) {
  double squares = 0;
  for (std::size_t k = kBumps; k < a.grains.size(); ++k) {
    squares += (a.grains[k].position - b.grains[k].position).squaredNorm();
  }
  return std::sqrt(squares / kGrains);
}

/// |mean of exp(6 i theta)| of the lines between grains that are near: 1 on a triangular lattice.
double hexagonal_order(const std::vector<VectorOf<2>>& places) {
  constexpr double kNear = 1.4;
  std::complex<double> sum = 0;
  int pairs = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const VectorOf<2> way = places[j] - places[i];
      if (way.norm() > kNear) continue;
      sum += std::polar(1.0, 6 * std::atan2(way.y(), way.x()));
      ++pairs;
    }
  }
  return std::abs(sum) / pairs;
}
double order_of(const std::vector<Disk>& start) {
  std::vector<VectorOf<2>> places;
  for (const Disk& d : start) {
    if (d.size >= 0) places.emplace_back(d.x, d.y);
  }
  return hexagonal_order(places);
}
double order_of(const Snapshot& s) {
  std::vector<VectorOf<2>> places;
  for (const Grain& g : s.grains) {
    if (!g.fixed) places.emplace_back(g.position.x(), g.position.y());
  }
  return hexagonal_order(places);
}

// -- The ensembles -------------------------------------------------------------------------------

constexpr double kErrors = 3;  // ensembles agree within so many standard errors

class ImplicitEnsemble : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    for (int k = 0; k < kHeaps; ++k) add_heaps(1000 + k);
    print_table();
  }

  inline static Ensemble implicitly_, explicitly_, slippery_;
  inline static std::vector<double> apart_, order_at_start_, order_at_end_;
  inline static ImplicitTally tally_;

 private:
  static void add_heaps(std::uint64_t seed) {
    Laws slippery;
    slippery.friction = 0.25;
    const std::vector<Disk> start = loose_triangle(seed);
    const Snapshot implicitly = settled_implicitly({}, start, tally_);
    const Snapshot explicitly = settled_by_engine({}, start);
    implicitly_.push_back(figures_of(implicitly));
    explicitly_.push_back(figures_of(explicitly));
    slippery_.push_back(figures_of(settled_by_engine(slippery, start)));
    apart_.push_back(apart(implicitly, explicitly));
    order_at_start_.push_back(order_of(start));
    order_at_end_.push_back(order_of(implicitly));
  }

  static void print_table() {
    std::printf("%d heaps of %d disks, implicit steps of ten explicit ones\n", kHeaps, kGrains);
    std::printf("%-20s %18s %18s %18s %7s %18s\n", "", "implicit", "explicit", "difference",
                "errors", "friction 0.25");
    for (std::size_t f = 0; f < kFigures.size(); ++f) {
      const Mean a = mean_of(implicitly_, f), b = mean_of(explicitly_, f);
      const Mean change = difference(implicitly_, explicitly_, f), other = mean_of(slippery_, f);
      std::printf("%-20s %8.4f +- %6.4f %8.4f +- %6.4f %8.4f +- %6.4f %7.1f %8.4f +- %6.4f\n",
                  kFigures[f], a.value, a.error, b.value, b.error, change.value, change.error,
                  change.away(), other.value, other.error);
    }
    const auto apart = std::minmax_element(apart_.begin(), apart_.end());
    std::printf("grains of a heap are %.2f to %.2f d apart; %.0f implicit steps, %.2f iterations\n",
                *apart.first, *apart.second, static_cast<double>(tally_.steps) / kHeaps,
                static_cast<double>(tally_.iterations) / static_cast<double>(tally_.solves));
  }
};

// By chance the order is about one over the root of the number of pairs, 0.1.
TEST_F(ImplicitEnsemble, IsDisorderedAndDiffersGrainByGrain) {
  for (int k = 0; k < kHeaps; ++k) {
    EXPECT_LT(order_at_start_[k], 0.4) << k;
    EXPECT_LT(order_at_end_[k], 0.4) << k;
    EXPECT_GT(apart_[k], 0.1) << k;
  }
  EXPECT_LT(mean_of([](int k) { return order_at_start_[k]; }).value, 0.15);
  EXPECT_LT(mean_of([](int k) { return order_at_end_[k]; }).value, 0.15);
}

// Forces that balance to kRest of a contact's miss the weight by no more.
TEST_F(ImplicitEnsemble, TheBaseCarriesTheWeight) {
  for (int k = 0; k < kHeaps; ++k) {
    EXPECT_NEAR(implicitly_[k][kCarried], 1, 10 * kRest) << k;
    EXPECT_NEAR(explicitly_[k][kCarried], 1, 10 * kRest) << k;
  }
}

TEST_F(ImplicitEnsemble, AgreesInContactsReposeHeightAndBasePressure) {
  for (std::size_t f = kContacts; f < kCarried; ++f) {
    const Mean change = difference(implicitly_, explicitly_, f);
    EXPECT_LT(change.away(), kErrors) << kFigures[f] << ": " << change.value;
    // Small enough to mean something.
    const double value = mean_of(explicitly_, f).value;
    const bool angle = f == kLeft || f == kRight;
    EXPECT_LT(change.error, angle ? 1 : (f == kContacts ? 0.01 : 0.03) * value) << kFigures[f];
  }
}

TEST_F(ImplicitEnsemble, ThePressureIsThatOfAHeap) {
  for (const Ensemble& e : {implicitly_, explicitly_}) {
    const Mean above = mean_of([&](int k) { return e[k][kMiddle] - e[k][kShoulders]; });
    EXPECT_GT(above.value, 0);
    EXPECT_GT(above.away(), kErrors);
  }
}

// Half the friction in one of the movers would be seen.
TEST_F(ImplicitEnsemble, IsToldFromOneOfAnotherFriction) {
  const Mean contacts = difference(slippery_, implicitly_, kContacts);
  EXPECT_GT(contacts.away(), 2 * kErrors) << contacts.value;
  EXPECT_GT(contacts.value, 0);
}

}  // namespace
}  // namespace grainfield::dem::testing
