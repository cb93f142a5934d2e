// Layers that a piston loads, and layers of regular polygons.
#include "coupling/studies/point_load/piston.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "coupling/studies/point_load/simulation.h"
#include "dem/shared/computation_failed.h"
#include "tests/coupling/finished_run.h"
#include "tests/dem/imbalance.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

// A disk on a floor is a spring, the piston another in front of it: together they give way by
// F/k + F/k_p, and what the piston does is in the springs and dashpots.
TEST(Piston, PressesADiskOnAFloorAsTwoSprings) {
  const double stiffness = 1e7, soft = 4e6, speed = 1e-3, force = 100;
  EngineSettings s;
  s.law = LinearLaw{stiffness, stiffness, 500, 250};
  s.gravity_y = 0;
  s.time_step = 1e-6;
  s.energy_balance = true;
  const auto engine = make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
  NewGrain disk;
  disk.y = disk.radius = 0.0045;
  disk.density = 5000;
  const std::int64_t id = engine->add(disk);
  const Stroke stroke{id, 0, disk.y, 0};
  const auto piston = std::make_shared<Piston>(stroke, speed, soft, force);
  added_forces(*engine).add_force(piston);
  double last = 0;
  while (!piston->presses_fully()) {
    engine->step(100);
    ASSERT_LT(engine->time(), 1);
    ASSERT_GE(piston->force(), 0.98 * last);  // it swings by speed * sqrt(m k)
    last = piston->force();
  }
  const double way = force / stiffness + force / soft;
  EXPECT_NEAR(engine->time() * speed, way, 0.02 * way);
  // Held, whatever the piston goes on to.
  engine->step(200000);
  EXPECT_EQ(piston->force(), force);
  const Snapshot held = engine->snapshot();
  EXPECT_NEAR(disk.y - held.grains[0].position.y(), force / stiffness, 1e-6 * force / stiffness);
  const Diagnostics d = engine->measure();
  EXPECT_NEAR(d.elastic_energy, 0.5 * force * force / stiffness, 1e-5 * d.elastic_energy);
  EXPECT_GT(d.applied_work, d.elastic_energy);
  EXPECT_NEAR(d.energy_balance(), 0, 1e-4 * d.applied_work);
}

PointLoadSetup lattice(const std::string& shape) {
  PointLoadSetup s;
  s.packing.kind = "triangular";
  s.packing.sizes = "mono";
  s.packing.shape = shape;
  s.packing.columns = 8;
  s.packing.rows = 4;
  s.load.force = 5;
  s.load.control = "speed";
  s.rest.unbalanced_force_ratio = 1e-5;
  return s;
}

TEST(Piston, LoadsALayerWithTheForce) {
  for (const char* shape : {"disk", "regular"}) {
    PointLoadSetup s = lattice(shape);
    s.motion.energy_balance = true;
    const RunResult r = finished(make_point_load_run(s, 3, 1));
    EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-3) << shape;
    EXPECT_NEAR(r.figures.at("base.response_over_load"), 1, 1e-2) << shape;
    const Snapshot& loaded = r.snapshots[1].second;
    EXPECT_EQ(loaded.applied_force.y(), -5);
    EXPECT_EQ(loaded.attributes.count("former_added_forces"), 0u);
    expect_balanced(loaded, 1e-4, shape);
    // The piston's own spring gives way by force over young; the layer by as much again or more.
    const double time = r.figures.at("load.time");
    EXPECT_GT(time * s.load.speed, 2 * s.load.force / s.material.young) << shape;
    EXPECT_LT(time, 1) << shape;
    EXPECT_GT(r.figures.at("energy.work_of_load"), 0) << shape;
    EXPECT_LT(std::fabs(r.figures.at("energy.balance_error")), 1e-2) << shape;
  }
}

// Slow enough, it leaves the layer where the ramp does; nothing opens, closes or slides at 0.2 N.
TEST(Piston, LeavesTheLayerAsTheRampDoes) {
  PointLoadSetup s = lattice("disk");
  s.load.force = 0.2;
  s.rest.unbalanced_force_ratio = 1e-7;
  s.rest.kinetic_to_elastic_energy = 1e-12;
  s.load.speed = 1e-5;
  const RunResult a = finished(make_point_load_run(s, 5, 1));
  s.load.control = "force";
  const RunResult b = finished(make_point_load_run(s, 5, 1));
  EXPECT_EQ(b.figures.count("load.time"), 0u);
  ASSERT_TRUE(same(a.snapshots[0].second, b.snapshots[0].second));
  EXPECT_LT(
      difference_of_moves(a.snapshots[0].second, b.snapshots[1].second, a.snapshots[1].second),
      0.02);
}

TEST(Piston, ResumesToTheSameBitsWhileItComesDown) {
  const FileOfRun file("piston");
  for (const char* shape : {"disk", "regular"}) {
    PointLoadSetup s = lattice(shape);
    s.load.speed = 1e-3;
    const RunResult expected = finished(make_point_load_run(s, 9, 1));
    const auto first = make_point_load_run(s, 9, 1), second = make_point_load_run(s, 9, 2);
    while (first->progress().phase != "load") first->advance(50);
    first->advance(57);
    ASSERT_EQ(first->progress().phase, "load") << shape;
    first->save(file.path());
    second->restore(file.path());
    expect_same(finished(second), expected, shape);
    // Back to a moment before the load: the piston goes.
    const auto early = make_point_load_run(s, 9, 1);
    early->advance(10);
    early->save(file.path());
    first->restore(file.path());
    expect_same(finished(first), expected, shape);
  }
}

TEST(Piston, SaysWhenTheLayerDoesNotResist) {
  PointLoadSetup s = lattice("disk");
  s.load.force = 300;
  s.load.speed = 1e-6;
  s.rest.max_time = 3;
  const std::string said = failure_of(make_point_load_run(s, 1, 1));
  EXPECT_THAT(said, testing::HasSubstr("the piston meets "));
  EXPECT_THAT(said, testing::HasSubstr("load.speed"));
}

std::string refusal(const PointLoadSetup& s) {
  return refusal_of([&] { make_point_load_run(s, 1, 1); });
}

TEST(Piston, IsRefusedWhereItHasNoMeaning) {
  PointLoadSetup s = lattice("disk");
  s.load.method = "newton";
  EXPECT_THAT(refusal(s), testing::HasSubstr("load.control: found \"speed\" with load.method"));
  s = {};
  s.packing.dim = 3;
  s.packing.kind = "random";
  s.material.law = "hertz";
  s.load.control = "speed";
  EXPECT_THAT(refusal(s), testing::HasSubstr("load.control: found \"speed\" with packing.dim = 3"));
  s.load.control = "force";
  s.packing.shape = "regular";
  EXPECT_THAT(refusal(s), testing::HasSubstr("packing.shape: found regular"));
  for (const int corners : {2, 65}) {
    s = lattice("regular");
    s.packing.corners = corners;
    EXPECT_THAT(refusal(s), testing::HasSubstr("packing.corners: found "));
  }
}

TEST(RegularPolygons, StandWhereDisksWould) {
  for (const char* kind : {"triangular", "sqrt3"}) {
    PackingSetup p = lattice("disk").packing;
    p.kind = kind;
    p.floor = "rough";
    Random random(1), other(1);
    GrainSupply disks(p, random);
    std::vector<NewGrain> round = floor_grains(p, disks, 1, random);
    for (const NewGrain& g : lattice_grains(p, 1, random)) round.push_back(g);
    p.shape = "regular";
    p.corners = 12;
    GrainSupply polygons(p, other);
    std::vector<NewGrain> many = floor_grains(p, polygons, 1, other);
    for (const NewGrain& g : lattice_grains(p, 1, other)) many.push_back(g);
    ASSERT_EQ(many.size(), round.size());
    std::set<double> angles;
    for (std::size_t k = 0; k < many.size(); ++k) {
      EXPECT_EQ(many[k].x, round[k].x);
      EXPECT_EQ(many[k].y, round[k].y);
      EXPECT_EQ(many[k].fixed, round[k].fixed);
      EXPECT_NEAR(many[k].radius, round[k].radius, 1e-12);
      EXPECT_EQ(many[k].outline.size(), 12u);
      angles.insert(many[k].angle);
    }
    EXPECT_EQ(angles.size(), many.size());
  }
}

TEST(RegularPolygons, FallInRows) {
  PointLoadSetup s = lattice("regular");
  s.packing.kind = "layered";
  s.packing.sizes = "bidisperse";
  s.packing.corners = 16;
  s.packing.width = 0.08;
  s.packing.depth = 0.02;
  s.rest.unbalanced_force_ratio = 1e-4;
  s.rest.kinetic_to_elastic_energy = 1e-6;
  const RunResult r = finished(make_point_load_run(s, 4, 1));
  EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-3);
  EXPECT_NEAR(r.figures.at("base.response_over_load"), 1, 2e-2);
  std::set<double> radii;
  for (const Grain& g : r.snapshots[0].second.grains) {
    EXPECT_EQ(g.outline.size(), 16u);
    radii.insert(std::round(g.radius * 1e6));
  }
  EXPECT_EQ(radii, (std::set<double>{3500, 4500}));
}

}  // namespace
}  // namespace grainfield::dem
