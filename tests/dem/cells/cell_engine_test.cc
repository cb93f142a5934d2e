// What does not go with a cell, what is said then, and how a snapshot carries one.
#include <gmock/gmock.h>

#include "tests/dem/cell_scene.h"
#include "tests/refusal.h"

namespace grainfield::dem::cells {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

NewGrain grain(double x, double y, double radius) {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.radius = radius;
  g.density = 1000;
  return g;
}

EngineSettings periodic_in_x() {
  Cell<3> cell;
  cell.periodic[0] = true;
  cell.edges.col(0) = Vec3(1, 0, 0);
  return settings_of(ShapeKind::disk, cell);
}

TEST(CellEngine, RefusesWalls) {
  const auto engine = make_engine(periodic_in_x());
  const auto wall = [&](const std::string& shape, const Vec3& normal) {
    Wall w;
    w.name = "lid";
    w.shape = shape;
    w.normal = normal;
    return refusal_of([&] { engine->add_wall(w); });
  };
  EXPECT_EQ(wall("plane", {0, -1, 0}), "accepted");
  EXPECT_EQ(wall("plane", {0.6, 0.8, 0}),
            "wall \"lid\": found a plane across that edge in a cell that repeats along (1, 0, 0) m "
            "(axis x), allowed: planes along the periodic edges");
  EXPECT_THAT(wall("cylinder", {0, 1, 0}), HasSubstr("found a circle"));
  EXPECT_THAT(wall("mesh", {0, 1, 0}), HasSubstr("found a mesh that ends"));
}

TEST(CellEngine, RefusesGrainsThatAreTooLarge) {
  const auto engine = make_engine(periodic_in_x());
  EXPECT_EQ(refusal_of([&] { engine->add(grain(0, 0, 0.23)); }), "accepted");
  EXPECT_EQ(refusal_of([&] { engine->add(grain(0, 0, 0.25)); }),
            "cell.edges: found 1 m from a place to its nearest image, allowed for grains of radius "
            "0.25 m: at least 1.05 m (4.2 radii; else a grain would touch another one, or itself, "
            "by two images)");
  engine->step(3);
  EXPECT_EQ(engine->grains(), 1);
}

TEST(CellEngine, RefusesRestInAFlow) {
  EngineSettings settings = periodic_in_x();
  Matrix3d flow = Matrix3d::Zero();
  flow(0, 0) = -0.1;
  const auto engine = make_engine(settings);
  engine->add(grain(0, 0, 0.1));
  EXPECT_EQ(refusal_of([&] { engine->set_velocity_gradient(flow); }), "accepted");
  NewGrain fixed = grain(0.5, 0.5, 0.1);
  fixed.fixed = true;
  EXPECT_THAT(refusal_of([&] { engine->add(fixed); }),
              StartsWith("cell.velocity_gradient: found a flow with fixed grains"));
  EXPECT_THAT(refusal_of([&] { engine->set_sleep(true); }),
              StartsWith("cell.velocity_gradient: found a flow with sleeping"));
  EXPECT_THAT(refusal_of([&] { engine->set_velocity_gradient(simple_shear(1)); }),
              StartsWith("cell.velocity_gradient: found a flow that goes"));
  engine->set_velocity_gradient(Matrix3d::Zero());
  engine->add(fixed);
  engine->set_sleep(true);
  EXPECT_THAT(refusal_of([&] { engine->set_velocity_gradient(flow); }), HasSubstr("fixed grains"));
  settings.cell.velocity_gradient = flow;
  settings.sleep.on = true;
  EXPECT_THAT(refusal_of([&] { make_engine(settings); }), HasSubstr("with sleeping"));
  settings.cell.edges.setZero();
  EXPECT_THAT(refusal_of([&] { make_engine(settings); }),
              StartsWith("cell.edges: found (0, 0, 0) m"));
}

TEST(CellEngine, EndsWhenTheCellIsTooSmall) {
  for (const int threads : {1, 3}) {
    EngineSettings settings = settings_of(ShapeKind::disk, cell_of(2, {0, 0, 0}, square(1)));
    settings.cell.velocity_gradient = -square(20);
    settings.cell.velocity_gradient(2, 2) = 0;
    settings.threads = threads;
    const auto engine = make_engine(settings);
    engine->add(grain(0.2, 0.2, 0.15));
    try {
      engine->step(10000);
      FAIL();
    } catch (const ComputationFailed& e) {
      EXPECT_THAT(e.what(), AllOf(StartsWith("the cell has become too small at t = 0.0"),
                                  HasSubstr("needed for grains of radius 0.15 m: 0.63 m"),
                                  HasSubstr("end cell.velocity_gradient earlier")));
    }
    EXPECT_LT(engine->cell().edges(0, 0), 0.63);
    EXPECT_GT(engine->cell().edges(0, 0), 0.62);
  }
}

// A grain that only moves with the flow is fast far from the origin, and has not diverged.
TEST(CellEngine, FarFromTheOriginNothingDiverges) {
  const EngineSettings settings =
      settings_of(ShapeKind::disk, cell_of(2, {0, 0, 0}, square(100), simple_shear(40)));
  const auto engine = make_engine(settings);
  NewGrain g = grain(10, 90, 0.01);
  g.vx = 40 * 90;  // 0.7 m a step
  engine->add(g);
  engine->step(1000);
  EXPECT_LT(engine->motion().kinetic_energy, 1e-15);
  g.vx += 40;
  engine->add(g);
  EXPECT_THROW(engine->step(10), ComputationFailed);
}

// The next run's engine goes on from a snapshot with the same forces.
TEST(CellEngine, GoesOnFromASnapshot) {
  for (const ShapeKind& shape : {ShapeKind::disk, ShapeKind::polygon, ShapeKind::sphere}) {
    const int dim = shape == ShapeKind::sphere ? 3 : 2;
    EngineSettings settings =
        settings_of(shape, cell_of(dim, {0, 0, 0}, square(1), simple_shear(4)));
    const auto engine = engine_with(settings, block(shape, settings.cell, dim == 2 ? 10 : 5, 2));
    engine->step(1500);
    const Snapshot s = engine->snapshot();
    EXPECT_NE(s.cell.edges(0, 1), 0);
    const auto other = make_engine(settings, s);
    engine->step(1);
    other->step(1);
    const Snapshot a = engine->snapshot(), b = other->snapshot();
    EXPECT_EQ(a.cell.edges, b.cell.edges);
    ASSERT_EQ(a.contacts.size(), b.contacts.size());
    const double mean = engine->measure().mean_contact_force;
    for (std::size_t k = 0; k < a.contacts.size(); ++k) {
      EXPECT_LT((a.contacts[k].force - b.contacts[k].force).norm(), 1e-2 * mean);
      EXPECT_EQ(a.contacts[k].image, b.contacts[k].image);
    }
    for (std::size_t k = 0; k < a.grains.size(); ++k) {
      EXPECT_EQ(a.grains[k].image, b.grains[k].image);
    }
  }
}

TEST(CellEngine, StressNeedsACell) {
  const auto engine = make_engine(periodic_in_x());
  EXPECT_EQ(refusal_of([&] { cell_stress(engine->snapshot()); }),
            "the stress of a cell: found a cell that is not periodic along axis y, allowed: "
            "periodic along all 2");
  EXPECT_EQ(refusal_of([&] { engine->cell_stress(); }),
            "the stress of a cell: found a cell that is not periodic along axis y, allowed: "
            "periodic along all 2");
}

// Layers between floor and lid in a cell that is stretched along x alone.
TEST(CellEngine, FlowsBetweenWalls) {
  EngineSettings settings = periodic_in_x();
  settings.cell.velocity_gradient(0, 0) = 0.5;
  const auto engine = make_engine(settings);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
  engine->add_wall({"lid", {0, 0.5, 0}, {0, -1, 0}, 0.5});
  Random random(5);
  for (int k = 0; k < 60; ++k) {
    engine->add(grain((k % 12 + 0.5) / 12, (k / 12 + 0.5) / 10, random.uniform(0.04, 0.052)));
  }
  engine->step(2000);
  const Snapshot s = engine->snapshot();
  EXPECT_NEAR(s.cell.edges(0, 0), std::exp(0.5 * engine->time()), 1e-6);
  for (const Grain& g : s.grains) {
    EXPECT_GT(g.position.y(), 0);
    EXPECT_LT(g.position.y(), 0.5);
    EXPECT_GE(g.position.x(), 0);
    EXPECT_LE(g.position.x(), s.cell.edges(0, 0));
  }
}

}  // namespace
}  // namespace grainfield::dem::cells
