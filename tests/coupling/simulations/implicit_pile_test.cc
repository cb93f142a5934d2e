// Lattice piles settled by implicit motion: closed forms, the explicit engine, what holds them.
#include <gtest/gtest.h>

#include "coupling/studies/lattice_pile/simulation.h"
#include "tests/coupling/lattice_pile_scene.h"
#include "tests/dem/implicit_scene.h"

namespace grainfield::dem::testing {
namespace {

/// The same pile for both movers: linear law, no friction between disks, a floor whose springs hold
/// the lowest row.
SoftScene scene_of(const LatticePileSetup& s) {
  const double mass = s.material.density * std::numbers::pi * s.lattice.radius * s.lattice.radius;
  SoftScene out;
  out.gravity = {0, -s.material.gravity};
  out.background_damping = s.rest.background_damping;
  out.grains.stiffness = s.material.normal_stiffness;
  out.grains.damping = 0.5 * mass * s.material.normal_damping;
  SoftLaw floor = out.grains;
  floor.damping *= 2;
  floor.friction = SoftFriction::coulomb;
  floor.coulomb = s.material.floor_friction;
  floor.tangential_stiffness = s.material.tangential_stiffness;
  out.walls = {ground(floor)};
  return out;
}

double mass_of(const LatticePileSetup& s) {
  return s.material.density * std::numbers::pi * s.lattice.radius * s.lattice.radius;
}

/// Goes on until forces balance to `ratio`; false where they do not in so many steps.
bool settle(SoftDisks& disks, double ratio, long most) {
  for (long k = 0; k < most; k += 20) {
    disks.step(20);
    if (disks.rest().ratio < ratio) return true;
  }
  return false;
}

struct Base {
  std::vector<double> normal, horizontal;  // N of each base disk on the ground, N
  int row_contacts = 0;
};
Base base_of(const SoftDisks& disks, int count) {
  Base out;
  out.normal.resize(count);
  out.horizontal.resize(count);
  for (const SoftTouch& t : disks.touches()) {
    if (t.j < 0) {
      out.normal[t.i] = t.repulsion;
      out.horizontal[t.i] = -t.tangential;  // t = (1, 0) for n = (0, -1)
    } else if (std::fabs(t.normal.y()) < 0.5) {
      ++out.row_contacts;
    }
  }
  return out;
}

void expect_closed_form(const Base& base, double weight, double within) {
  const int k = static_cast<int>(base.normal.size());
  const double most = weight * (k - 1) / (2 * std::numbers::sqrt3);
  for (int i = 1; i <= k; ++i) {
    const double n = 0.5 * (k + 1) * weight;
    const double h = weight * (2 * i - k - 1) / (2 * std::numbers::sqrt3);
    EXPECT_NEAR(base.normal[i - 1], n, within * n) << i;
    EXPECT_NEAR(base.horizontal[i - 1], h, within * most) << i;
  }
}

// Liffman's softness and rows that may touch, at ten times the explicit step.
TEST(ImplicitPile, SettlesToTheClosedFormAndToTheExplicitEnginesState) {
  LatticePileSetup s = pile_of(12, 60, 1e-4, "linear");
  s.lattice.gap = 0;
  s.rest.unbalanced_force_ratio = 1e-9;
  const double mass = mass_of(s), weight = mass * s.material.gravity;
  SoftDisks disks(scene_of(s), pile_bodies(s.lattice, s.material.density),
                  steps_of(10 * explicit_step(mass, s.material.normal_stiffness)));
  ASSERT_TRUE(settle(disks, 1e-9, 20000));
  EXPECT_EQ(disks.tally().halved, 0);
  const Base base = base_of(disks, 12);
  EXPECT_EQ(base.row_contacts, 0);
  expect_closed_form(base, weight, 0.01);

  const RunResult explicitly = at_rest(s);
  const Snapshot& state = explicitly.snapshots.front().second;
  double furthest = 0, forces = 0;
  for (std::size_t k = 0; k < state.grains.size(); ++k) {
    const Vec3& x = state.grains[k].position;
    const VectorOf<2> away = disks.bodies()[k].position - VectorOf<2>(x.x(), x.y());
    furthest = std::max(furthest, away.norm());
  }
  for (const Contact& c : state.contacts) {
    if (c.j >= 0) continue;
    forces = std::max({forces, std::fabs(c.force.y() - base.normal[c.i]),
                       std::fabs(-c.force.x() - base.horizontal[c.i])});
  }
  std::printf(
      "against the explicit engine: %.2e diameters, %.2e of N; %ld steps, %.2f iterations\n",
      furthest / (2 * s.lattice.radius), forces / base.normal[0], disks.tally().steps,
      static_cast<double>(disks.tally().iterations) / disks.tally().solves);
  EXPECT_LT(furthest, 1e-7 * 2 * s.lattice.radius);
  EXPECT_LT(forces, 1e-5 * base.normal[0]);
}

// The same rest by BDF2, at steps with which the conserving scheme goes on swinging.
TEST(ImplicitPile, Bdf2ComesToTheSameRestInFewLongSteps) {
  LatticePileSetup s = pile_of(12, 60, 1e-4, "linear");
  s.lattice.gap = 0;
  const double mass = mass_of(s);
  const double explicitly = explicit_step(mass, s.material.normal_stiffness);
  SoftDisks slow(scene_of(s), pile_bodies(s.lattice, s.material.density),
                 steps_of(10 * explicitly));
  ASSERT_TRUE(settle(slow, 1e-9, 20000));
  SoftDisks fast(scene_of(s), pile_bodies(s.lattice, s.material.density),
                 steps_of(500 * explicitly, ImplicitScheme::bdf2));
  ASSERT_TRUE(settle(fast, 1e-9, 2000));
  const Base a = base_of(slow, 12), b = base_of(fast, 12);
  double forces = 0;
  for (std::size_t k = 0; k < a.normal.size(); ++k) {
    forces = std::max({forces, std::fabs(a.normal[k] - b.normal[k]),
                       std::fabs(a.horizontal[k] - b.horizontal[k])});
  }
  EXPECT_LT(forces, 1e-5 * a.normal[0]);
  std::printf(
      "conserving: %ld steps of 10, %ld iterations; BDF2: %ld steps of 500, %ld iterations, "
      "%ld halved\n",
      slow.tally().steps, slow.tally().iterations, fast.tally().steps, fast.tally().iterations,
      fast.tally().halved);
  EXPECT_LT(fast.tally().iterations, slow.tally().iterations / 4);
}

/// The source's laws on all contacts (or coulomb instead of viscous), slip damping in units of
/// sqrt(m K), with or without wells of half width 1e-3 d under the lowest row.
struct Ways {
  SoftFriction friction = SoftFriction::viscous;
  double slip = 0.5;
  bool well = false, base_spins = false;
};

SoftDisks pile_moved(const Ways& ways, int base) {
  LatticePileSetup s = pile_of(base, 60, 1e-4, "linear");
  s.lattice.gap = 0;
  const double mass = mass_of(s), stiffness = s.material.normal_stiffness;
  const double dashpot = std::sqrt(mass * stiffness);
  SoftScene scene;
  scene.gravity = {0, -s.material.gravity};
  scene.grains.stiffness = stiffness;
  scene.grains.damping = 0.2 * dashpot;
  scene.grains.friction = ways.friction;
  scene.grains.slip_damping = ways.slip * dashpot;
  scene.grains.rolling_friction = scene.grains.coulomb = 0.9;
  scene.grains.tangential_stiffness = 2.0 / 7 * stiffness;
  SoftLaw floor = scene.grains;
  if (ways.well) {
    floor.static_friction = 1;
    floor.well = 1e-3 * 2 * s.lattice.radius;
  }
  scene.walls = {ground(floor)};
  std::vector<Body<2>> disks = pile_bodies(s.lattice, s.material.density);
  if (ways.base_spins) {
    for (Body<2>& b : disks) b.inverse_inertia = 2 * b.inverse_mass / (b.radius * b.radius);
  }
  return SoftDisks(scene, disks, steps_of(10 * explicit_step(mass, stiffness)));
}

/// How far the outermost base disks are apart, in diameters.
double width_of(const SoftDisks& disks, int base) {
  const Body<2>&a = disks.bodies()[0], &b = disks.bodies()[base - 1];
  return (b.position.x() - a.position.x()) / (2 * a.radius);
}

// The source's own model: viscous friction and the ground's well.
TEST(ImplicitPile, WellsHoldThePileOfTheSource) {
  for (const bool spins : {false, true}) {
    SoftDisks disks = pile_moved({SoftFriction::viscous, 0.5, true, spins}, 12);
    const double weight = 9.81 / disks.bodies()[0].inverse_mass;
    ASSERT_TRUE(settle(disks, 1e-9, 4000)) << disks.rest().ratio;
    expect_closed_form(base_of(disks, 12), weight, 0.01);
    // H/N = 11/(13 sqrt 3) of the half width to either side.
    EXPECT_NEAR(width_of(disks, 12) - 11, 2 * 1e-3 * 11 / (13 * std::numbers::sqrt3), 1e-4);
  }
}

// Viscous friction vanishes at rest: the base goes apart steadily, as much more slowly as friction
// is stronger, but it never stops.
TEST(ImplicitPile, CreepsWhereNothingHoldsAtRest) {
  std::vector<double> speeds;
  for (const double slip : {0.5, 5.0}) {
    SoftDisks disks = pile_moved({SoftFriction::viscous, slip, false, false}, 12);
    disks.step(100);
    const double t0 = disks.time(), w0 = width_of(disks, 12);
    disks.step(100);
    const double t1 = disks.time(), w1 = width_of(disks, 12);
    disks.step(100);
    const double first = (w1 - w0) / (t1 - t0);
    const double second = (width_of(disks, 12) - w1) / (disks.time() - t1);
    EXPECT_NEAR(second / first, 1, 0.05) << slip;
    EXPECT_GT(disks.rest().ratio, 0.05);
    speeds.push_back(second);
    // H of the outermost disk on K_slip alone; the row above drags on it, too.
    const Body<2>& edge = disks.bodies()[11];
    const double mass = 1 / edge.inverse_mass, d = 2 * edge.radius;
    const double dashpot = slip * mass * std::sqrt(9.81 / (1e-4 * d));
    const double alone = 2 * mass * 9.81 * 11 / (2 * std::numbers::sqrt3) / dashpot / d;
    EXPECT_LT(second, alone);
    EXPECT_GT(second, 0.5 * alone);
  }
  // The faster one has become wider, and steeper its lines of force: 5 % more.
  EXPECT_NEAR(speeds[0] / speeds[1], 10.5, 0.5);
}

// Beyond the source: Coulomb friction with memory holds a base that cannot roll. One that can
// rolls apart on any friction.
TEST(ImplicitPile, CoulombHoldsABaseThatCannotRoll) {
  SoftDisks held = pile_moved({SoftFriction::coulomb, 0.5, false, false}, 12);
  EXPECT_TRUE(settle(held, 1e-9, 4000)) << held.rest().ratio;
  EXPECT_LT(width_of(held, 12) - 11, 0.005);
  SoftDisks rolls = pile_moved({SoftFriction::coulomb, 0.5, false, true}, 12);
  rolls.step(100);
  EXPECT_GT(width_of(rolls, 12) - 11, 1);
}

}  // namespace
}  // namespace grainfield::dem::testing
