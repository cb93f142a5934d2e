// Lattice piles settled by implicit motion: closed forms, the explicit engine, what holds them.
#include <gtest/gtest.h>

#include "tests/dem/implicit_scene.h"
#include "tests/dem/lattice_pile_scene.h"

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

}  // namespace
}  // namespace grainfield::dem::testing
