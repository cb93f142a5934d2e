// Engines that go on from snapshots, through a file: the same forces from the same state.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "tests/damaged_files.h"

namespace grainfield::dem {
namespace {

using ::testing::HasSubstr;

// Laws without dashpots: the force belongs to the place alone, so that two engines in the same
// state step alike.
EngineSettings settings(int dim, bool hertz) {
  EngineSettings s;
  s.shape = dim == 2 ? ShapeKind::disk : ShapeKind::sphere;
  s.integrator = IntegratorKind::verlet;
  s.time_step = 2e-6;
  s.materials = {"glass", "steel"};
  const auto law = [&](double scale) {
    return hertz ? AnyLaw(HertzLaw{5e7 * scale, 0.25, 0})
                 : AnyLaw(LinearLaw{1e5 * scale, 3e4, 0, 0});
  };
  s.material_pairs = {{"glass", "glass", law(1), 0.4},
                      {"glass", "steel", law(1.5), 0.3},
                      {"steel", "steel", law(2), 0.6}};
  return s;
}

// A heap on a floor that begins to move again: some of its grains steel, one fixed, one that never
// turns, one loaded.
std::unique_ptr<Engine> moving_heap(int dim, bool hertz) {
  auto engine = make_engine(settings(dim, hertz));
  Wall floor{"floor", {0, 0, 0}, dim == 2 ? Vec3(0, 1, 0) : Vec3(0, 0, 1), 0.5};
  Wall side{"side", {0, 0, 0}, Vec3(1, 0, 0), 0};
  side.material = "steel";
  engine->add_wall(floor);
  engine->add_wall(side);
  Random random(3);
  const int deep = dim == 3 ? 3 : 1;
  for (int k = 0; k < 36; ++k) {
    NewGrain g;
    const int column = k % 4, row = k / 4 % deep, level = k / (4 * deep);
    const auto at = [&](int n) { return 0.00998 * (n + 0.5) + 1e-5 * random.uniform(); };
    g.x = at(column);
    g.y = dim == 3 ? at(row) : at(level);
    g.z = dim == 3 ? at(level) : 0;
    g.vx = 0.1 * random.uniform() - 0.05;
    g.spin = 20 * random.uniform() - 10;
    g.radius = 0.005;
    g.density = 2500;
    g.material = k % 3 == 0 ? "steel" : "glass";
    g.fixed = k == 5;
    g.rotates = k != 7;
    if (dim == 3) {
      g.vy = 0.1 * random.uniform() - 0.05;
      g.spin_x = 20 * random.uniform() - 10;
    }
    engine->add(g);
  }
  if (dim == 2)
    engine->set_gravity(0, -500);
  else
    engine->set_gravity(0, 0, -500);
  engine->set_background_damping(300);
  engine->step(6000);
  engine->set_background_damping(0);
  AppliedForce force;
  force.id = 11;
  force.fx = 0.3;
  (dim == 2 ? force.fy : force.fz) = -0.5;
  engine->apply(force);
  engine->step(300);
  return engine;
}

Snapshot through_a_file(const Snapshot& s) {
  const testing::TestFolder folder;
  write_snapshot(folder / "s.h5", "/s", s);
  return read_snapshot(folder / "s.h5", "/s");
}

double largest_force(const Snapshot& s) {
  double largest = 0;
  for (const Contact& c : s.contacts) largest = std::max(largest, c.force.norm());
  return largest;
}

// The largest difference of a contact's force over the largest force; infinite for other contacts.
double difference(const Snapshot& a, const Snapshot& b) {
  if (a.contacts.size() != b.contacts.size()) return INFINITY;
  double worst = 0;
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    const Contact &c = a.contacts[k], &d = b.contacts[k];
    if (c.i != d.i || c.j != d.j) return INFINITY;
    worst = std::max({worst, (c.force - d.force).norm(), (c.spring_vector - d.spring_vector).norm(),
                      std::fabs(c.spring - d.spring)});
  }
  return worst / largest_force(a);
}

struct Kind {
  int dim;
  bool hertz;
};

class FromSnapshot : public ::testing::TestWithParam<Kind> {};

TEST_P(FromSnapshot, ForcesGoOnAsTheyWere) {
  const auto [dim, hertz] = GetParam();
  const auto engine = moving_heap(dim, hertz);
  const Snapshot state = through_a_file(engine->snapshot());
  ASSERT_GT(state.contacts.size(), 30U);
  const auto again = make_engine(settings(dim, hertz), state);
  engine->step(1);
  again->step(1);
  EXPECT_LT(difference(engine->snapshot(), again->snapshot()), 1e-12);
  engine->step(200);
  again->step(200);
  const Snapshot a = engine->snapshot(), b = again->snapshot();
  EXPECT_LT(difference(a, b), 1e-8);  // rounding grows in collisions
  for (std::size_t k = 0; k < a.grains.size(); ++k) {
    EXPECT_EQ(a.grains[k].material, b.grains[k].material);
    EXPECT_EQ(a.grains[k].rotates, b.grains[k].rotates);
    EXPECT_EQ(a.grains[k].mass, b.grains[k].mass);
    EXPECT_EQ(a.grains[k].inertia, b.grains[k].inertia);
  }
  EXPECT_FALSE(a.grains[7].rotates);
  EXPECT_EQ(b.grains[7].spin, state.grains[7].spin);
  EXPECT_EQ(b.walls[1].material, "steel");
  EXPECT_EQ(b.loaded_grain, 11);
  EXPECT_EQ(b.applied_force, a.applied_force);
  EXPECT_NE(a.applied_force, Vec3(0, 0, 0));
}

// Each of what a snapshot brings is needed.
// What a wall of a snapshot has felt is not felt once more.
TEST_P(FromSnapshot, WallsFeelTheirContactsAlone) {
  const auto [dim, hertz] = GetParam();
  const Snapshot start = moving_heap(dim, hertz)->snapshot();
  ASSERT_GT(start.walls.front().force.norm(), 0);
  const auto engine = make_engine(settings(dim, hertz), start);
  for (int k = 0; k < 2; ++k) {
    const Snapshot now = engine->snapshot();
    std::vector<Vec3> felt(now.walls.size(), Vec3::Zero());
    for (const Contact& c : now.contacts) {
      if (c.j < 0) felt[static_cast<std::size_t>(-1 - c.j)] -= c.force;
    }
    for (std::size_t w = 0; w < felt.size(); ++w) {
      EXPECT_NEAR((now.walls[w].force - felt[w]).norm(), 0, 1e-12 * (1 + felt[w].norm())) << k;
    }
    engine->step(1);
  }
}

TEST_P(FromSnapshot, WithoutAnyPartTheyDiffer) {
  const auto [dim, hertz] = GetParam();
  const auto engine = moving_heap(dim, hertz);
  const Snapshot state = engine->snapshot();
  engine->step(100);
  const Snapshot end = engine->snapshot();
  const auto without = [&, d = dim, h = hertz](const auto& spoil) {
    Snapshot s = state;
    spoil(s);
    const auto other = make_engine(settings(d, h), s);
    other->step(100);
    return difference(end, other->snapshot());
  };
  EXPECT_LT(without([](Snapshot&) {}), 1e-9);
  EXPECT_GT(without([](Snapshot& s) {
              for (Contact& c : s.contacts) {
                c.spring = 0;
                c.spring_vector.setZero();
              }
            }),
            1e-4);
  EXPECT_GT(without([](Snapshot& s) { s.loaded_grain = -1; }), 1e-6);
  EXPECT_GT(without([](Snapshot& s) {
              for (Grain& g : s.grains) g.rotates = true;
            }),
            1e-6);
  EXPECT_GT(without([](Snapshot& s) {
              for (Grain& g : s.grains) g.material = "glass";
            }),
            1e-3);
  EXPECT_GT(without([](Snapshot& s) { s.walls[1].material = ""; }), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Shapes, FromSnapshot,
                         ::testing::Values(Kind{2, false}, Kind{3, false}, Kind{3, true}),
                         [](const auto& kind) {
                           return std::string(kind.param.dim == 2 ? "Disks" : "Spheres") +
                                  (kind.param.hertz ? "Hertz" : "Linear");
                         });

// The tangential force of a packing at rest is the spring.
TEST(FromSnapshotOf, AnotherProgramUnknownSpringsAreTheTangentialForce) {
  const auto engine = moving_heap(3, false);
  Snapshot state = engine->snapshot();
  for (Contact& c : state.contacts) {
    c.spring = NAN;
    c.spring_vector.setConstant(NAN);
  }
  const auto again = make_engine(settings(3, false), state);
  engine->step(1);
  again->step(1);
  EXPECT_LT(difference(engine->snapshot(), again->snapshot()), 1e-12);
}

TEST(FromSnapshotOf, AnotherMaterialIsRefused) {
  const auto engine = moving_heap(2, false);
  Snapshot state = engine->snapshot();
  state.grains[4].material = "stele";
  try {
    make_engine(settings(2, false), state);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("\"stele\""));
    EXPECT_THAT(e.what(), HasSubstr("steel"));
  }
}

}  // namespace
}  // namespace grainfield::dem
