// Small loads with one tangent stiffness: what Newton's method comes to for a load so small that
// it is linear, balance, superposition, refusals.
#include "dem/quasistatic/small_loads.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "dem/quasistatic/quasistatic.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/dem/sphere_relaxation_scene.h"

namespace grainfield::dem {
namespace {

using ::testing::HasSubstr;

struct Packing {
  EngineSettings settings;
  Snapshot rest;
  int up = 2;

  void relax_at(double ratio) {
    QuasistaticSettings how;
    how.unbalanced_force_ratio = ratio;
    rest = relax(rest, settings, rest.gravity, {}, how).state;
  }
  std::int64_t highest(double x_from = -1e9) const {
    const Grain* best = nullptr;
    for (const Grain& g : rest.grains) {
      if (g.fixed || g.position.x() < x_from) continue;
      if (best == nullptr || g.position[up] > best->position[up]) best = &g;
    }
    return best->id;
  }
  double mean_weight() const { return rest.grains.back().mass * rest.gravity.norm(); }
};

// Disks of many sizes, dropped between walls.
const Packing& disks() {
  static const Packing one = [] {
    Packing p;
    p.up = 1;
    p.settings.law = OverlapAreaLaw{1e5, 0.75};
    p.settings.friction = 3;
    p.settings.integrator = IntegratorKind::verlet;
    p.settings.time_step = 5e-5;
    const auto engine = settled_disks(p.settings, 12, 8, 2);
    p.rest = engine->snapshot();
    p.relax_at(1e-12);
    return p;
  }();
  return one;
}

const Packing& spheres() {
  static const Packing one = [] {
    Packing p;
    p.settings = settings_of(LinearLaw{500, 250, 200, 100}, 3);
    p.rest = settled(p.settings, true, 4, 4)->snapshot();
    p.settings.cell = p.rest.cell;
    p.relax_at(1e-12);
    return p;
  }();
  return one;
}

AppliedForce on(std::int64_t id, const Vec3& force) {
  AppliedForce out;
  out.id = id;
  out.fx = force.x();
  out.fy = force.y();
  out.fz = force.z();
  return out;
}

using Forces = std::map<std::tuple<std::int64_t, std::int64_t, std::array<int, 3>>, Vec3>;
Forces forces_of(const Snapshot& s) {
  Forces out;
  for (const Contact& c : s.contacts) out[{c.i, c.j, c.image}] = c.force;
  return out;
}

// Half the difference between the load downwards and upwards: their part that is even in the load
// drops out.
void expect_as_newton(const Packing& p) {
  ASSERT_EQ(std::ranges::count_if(p.rest.contacts, [](const Contact& c) { return c.sliding; }), 0);
  const std::int64_t id = p.highest();
  const double size = 1e-4 * p.mean_weight();
  const Vec3 force = -size * Vec3::Unit(p.up) + 0.3 * size * Vec3::Unit(0);
  SmallLoads loads(p.rest, p.settings);
  const SmallResponse linear = loads.response({id}, force);
  QuasistaticSettings how;
  how.unbalanced_force_ratio = 1e-12;
  const Snapshot with = relax(p.rest, p.settings, p.rest.gravity, on(id, force), how).state;
  const Snapshot against = relax(p.rest, p.settings, p.rest.gravity, on(id, -force), how).state;
  double most = 0, off = 0;
  for (std::size_t k = 0; k < p.rest.grains.size(); ++k) {
    const Vec3 moved = 0.5 * (with.grains[k].position - against.grains[k].position);
    most = std::max(most, moved.norm());
    off = std::max(off, (moved - linear.moved[k]).norm());
  }
  ASSERT_GT(most, 0);
  EXPECT_LT(off, 1e-6 * most);
  const Forces a = forces_of(with), b = forces_of(against), c = forces_of(linear.change);
  ASSERT_EQ(a.size(), c.size());
  ASSERT_EQ(b.size(), c.size());
  most = off = 0;
  int changed = 0;
  for (const auto& [key, change] : c) {
    const Vec3 newton = 0.5 * (a.at(key) - b.at(key));
    most = std::max(most, newton.norm());
    off = std::max(off, (newton - change).norm());
    changed += change.norm() > 1e-3 * size;
  }
  EXPECT_GT(changed, 20);
  EXPECT_GT(most, 0.3 * size);
  EXPECT_LT(off, 1e-6 * most);
}

TEST(SmallLoads, ChangeDisksAsNewtonsMethod) { expect_as_newton(disks()); }
TEST(SmallLoads, ChangeSpheresAsNewtonsMethod) { expect_as_newton(spheres()); }

// The forces of every grain, and of the walls, balance the load.
void expect_balance(const SmallResponse& r, const Vec3& force, double tolerance) {
  const Snapshot& s = r.change;
  std::vector<Vec3> sum(s.grains.size(), Vec3(0, 0, 0));
  Vec3 outside(0, 0, 0);
  for (const Contact& c : s.contacts) {
    sum[static_cast<std::size_t>(c.i)] += c.force;
    if (c.j >= 0) sum[static_cast<std::size_t>(c.j)] -= c.force;
    if (c.j < 0) outside += c.force;
  }
  Vec3 load(0, 0, 0);
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    if (s.grains[k].fixed) {
      outside -= sum[k];
      continue;
    }
    Vec3 rest = sum[k];
    if (is_loaded(s, s.grains[k].id)) {
      rest += force;
      load += force;
    }
    ASSERT_LT(rest.norm(), tolerance * force.norm()) << k;
  }
  EXPECT_LT((outside + load).norm(), tolerance * force.norm() * sum.size());
  EXPECT_LT((total_applied_force(s) - load).norm(), 1e-15);
}

TEST(SmallLoads, AreCarriedToTheBase) {
  for (const Packing* p : {&disks(), &spheres()}) {
    SmallLoads loads(p->rest, p->settings);
    const Vec3 force = -0.1 * Vec3::Unit(p->up);
    const SmallResponse r = loads.response({p->highest()}, force);
    expect_balance(r, force, 1e-9);
    EXPECT_LE(r.left, 1e-9);
    // Sides take vertical forces, too, where they have friction.
    if (p->up == 2) {
      EXPECT_NEAR(base_force(r.change).z(), 0.1, 1e-9);
    }
  }
}

TEST(SmallLoads, AddUp) {
  const Packing& p = disks();
  SmallLoads loads(p.rest, p.settings);
  const std::int64_t a = p.highest(), b = p.highest(p.rest.grains.back().position.x() - 0.02);
  ASSERT_NE(a, b);
  const Vec3 force(0, -2, 0);
  const SmallResponse both = loads.response({a, b}, force), first = loads.response({a}, force),
                      second = loads.response({b}, 3 * force);
  ASSERT_EQ(both.change.contacts.size(), first.change.contacts.size());
  for (std::size_t k = 0; k < both.change.contacts.size(); ++k) {
    const Vec3 sum = first.change.contacts[k].force + second.change.contacts[k].force / 3;
    ASSERT_LT((both.change.contacts[k].force - sum).norm(), 1e-8 * force.norm()) << k;
  }
  EXPECT_EQ(both.change.loaded_grain, a);
  EXPECT_THAT(both.change.also_loaded, ::testing::ElementsAre(b));
  EXPECT_EQ(both.change.gravity.norm(), 0);
}

// So many spheres that equations are solved by iteration: columns of a simple cubic lattice whose
// neighbours press on each other, on fixed spheres.
TEST(SmallLoads, OfManySpheresAreSolvedByIteration) {
  Packing p;
  p.settings = settings_of(LinearLaw{1e4, 1e4, 0, 0}, 5);
  constexpr int kSide = 12, kLayers = 9;
  const double a = 2 * kRadius * (1 - 1e-3);
  p.settings.cell.periodic = {true, true, false};
  p.settings.cell.edges = Vec3(kSide * a, kSide * a, 1).asDiagonal();
  const auto engine = make_engine(p.settings);
  for (int k = 0; k < kSide * kSide * kLayers; ++k) {
    NewGrain g =
        sphere(a * (Vec3(k % kSide, k / kSide % kSide, k / kSide / kSide) + Vec3::Constant(0.5)));
    g.fixed = k < kSide * kSide;
    engine->add(g);
  }
  p.rest = engine->snapshot();
  p.rest.gravity = Vec3(0, 0, -kG);
  p.relax_at(1e-10);
  SmallLoads loads(p.rest, p.settings);
  const Vec3 force(0, 0, -0.01);
  const SmallResponse r = loads.response({p.highest()}, force);
  EXPECT_GT(r.solves, 1);
  expect_balance(r, force, 1e-7);
  EXPECT_NEAR(base_force(r.change).z(), 0.01, 1e-7);
}

TEST(SmallLoads, RefuseWhatCarriesNothing) {
  Packing p = disks();
  const auto complaint = [&](const std::function<void()>& what) {
    try {
      what();
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  SmallLoads loads(p.rest, p.settings);
  EXPECT_THAT(complaint([&] {
                loads.response({123456}, {0, -1, 0});
              }),
              HasSubstr("found a force on grain 123456, allowed: the id of a free grain"));
  EXPECT_THAT(complaint([&] { loads.response({}, {0, -1, 0}); }), HasSubstr("found no load"));
  Snapshot lifted = p.rest;
  lifted.gravity *= 1.1;
  EXPECT_THAT(complaint([&] { SmallLoads{lifted, p.settings}; }), HasSubstr("is not at rest"));
  // A disk without weight that touches nothing.
  Grain loose = p.rest.grains.back();
  loose.id += 1;
  loose.position.y() += 1;
  loose.mass = 1e-30;
  p.rest.grains.push_back(loose);
  SmallLoads with_loose(p.rest, p.settings);
  EXPECT_THAT(complaint([&] {
                with_loose.response({loose.id}, {0, -1, 0});
              }),
              HasSubstr("nothing carries a force on grain"));
}

}  // namespace
}  // namespace grainfield::dem
