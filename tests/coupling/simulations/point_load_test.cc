// The point-load run: balance, restart to the same bits, and what it refuses.
#include <gmock/gmock.h>

#include <filesystem>

#include "coupling/studies/point_load/simulation.h"
#include "dem/grains/packing.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/coupling/finished_run.h"
#include "tests/dem/imbalance.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

PointLoadSetup small(const std::string& kind) {
  PointLoadSetup s;
  s.packing.kind = kind;
  s.packing.columns = 8;
  s.packing.rows = 4;
  s.packing.width = 0.08;
  s.packing.depth = 0.02;
  if (kind != "layered") s.packing.sizes = "mono";
  s.load.force = 5;
  s.load.ramp_time = 0.05;
  return s;
}

TEST(PointLoad, BaseCarriesWeightAndLoad) {
  for (const std::string kind : {"triangular", "sqrt3", "layered"}) {
    for (const char* floor : {"smooth", "rough"}) {
      PointLoadSetup s = small(kind);
      s.packing.floor = floor;
      const RunResult r = finished(make_point_load_run(s, 3, 1));
      EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-4) << kind << " " << floor;
      EXPECT_NEAR(r.figures.at("base.response_over_load"), 1, 1e-2) << kind << " " << floor;
      ASSERT_EQ(r.snapshots.size(), 2u);
      for (const auto& [name, state] : r.snapshots) expect_balanced(state, 1e-6, kind + name);
      EXPECT_EQ(r.snapshots[1].second.applied_force.y(), -5);
    }
  }
}

PointLoadSetup pentagons() {
  PointLoadSetup s = small("layered");
  s.packing.shape = "irregular";
  s.packing.side = 0.009;
  s.packing.width = 0.15;
  s.packing.depth = 0.04;
  s.rest.unbalanced_force_ratio = 1e-4;
  s.rest.kinetic_to_elastic_energy = 1e-6;
  return s;
}

TEST(PointLoad, LayersOfPentagonsCarryWeightAndLoad) {
  for (const char* floor : {"smooth", "rough"}) {
    PointLoadSetup s = pentagons();
    s.packing.floor = floor;
    const RunResult r = finished(make_point_load_run(s, 4, 1));
    EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-3) << floor;
    EXPECT_NEAR(r.figures.at("base.response_over_load"), 1, 2e-2) << floor;
    for (const Grain& g : r.snapshots[0].second.grains) EXPECT_EQ(g.outline.size(), 5u);
    EXPECT_GE(r.figures.at("dem.layer_height"), s.packing.depth);
    EXPECT_GT(r.figures.at("dem.volume_fraction"), 0.6);
  }
}

TEST(PointLoad, ResumesToTheSameBitsFromAnyStep) {
  const FileOfRun file("run");
  for (const bool disks : {true, false}) {
    PointLoadSetup s = disks ? small("layered") : pentagons();
    if (disks) {
      s.packing.width = 0.05;
      s.packing.depth = 0.02;
    }
    s.rest.unbalanced_force_ratio = 1e-3;
    const auto make = [&](int threads) { return make_point_load_run(s, 9, threads); };
    const RunResult expected = finished(make(1));
    Random random(1);
    expect_same_after_stops(make, expected, expected.figures.at("dem.steps"), 3, file, random);
    const auto other = make_point_load_run(s, 10, 1);
    EXPECT_THROW(other->restore(file.path()), std::invalid_argument);
    std::filesystem::resize_file(file.path(), std::filesystem::file_size(file.path()) / 2);
    EXPECT_THROW(make(1)->restore(file.path()), std::invalid_argument);
  }
}

// A small force: both ways to apply it move the grains alike, and Newton's is exact to its ratio.
TEST(PointLoad, NewtonAgreesWithDampedDynamics) {
  for (const bool disks : {true, false}) {
    PointLoadSetup s = disks ? small("layered") : pentagons();
    s.packing.width = 0.05;
    s.rest.unbalanced_force_ratio = 1e-7;
    s.rest.kinetic_to_elastic_energy = 1e-12;
    s.load.force = 0.2;
    const RunResult a = finished(make_point_load_run(s, 5, 1));
    s.load.method = "newton";
    const auto stopped = make_point_load_run(s, 5, 1);
    const RunResult b = finished(make_point_load_run(s, 5, 1));
    ASSERT_TRUE(same(a.snapshots[0].second, b.snapshots[0].second));
    ASSERT_EQ(a.figures.at("load.no_rearrangement"), 1) << disks;
    EXPECT_EQ(b.figures.at("load.no_rearrangement"), 1) << disks;
    expect_balanced(b.snapshots[1].second, 1e-8);
    // The figures are of the state that the run ends with, not of the one that was loaded.
    double contacts = 0, sliding = 0;
    for (const Contact& c : b.snapshots[1].second.contacts) {
      ++contacts;
      sliding += c.sliding ? 1 : 0;
    }
    EXPECT_EQ(b.figures.at("dem.contacts"), contacts);
    EXPECT_EQ(b.figures.at("dem.sliding_contacts"), sliding);
    const Imbalance left = imbalance_of(b.snapshots[1].second);
    EXPECT_NEAR(b.figures.at("dem.unbalanced_force_ratio"), left.force, 1e-10);
    EXPECT_NEAR(b.figures.at("dem.unbalanced_moment_ratio"), left.moment, 1e-10);
    EXPECT_GE(b.figures.at("load.load_steps"), 1);
    EXPECT_GE(b.figures.at("load.iterations"), b.figures.at("load.load_steps"));
    EXPECT_EQ(a.figures.count("load.iterations"), 0u);
    EXPECT_NEAR(b.figures.at("base.response_over_load"), 1, 1e-4) << disks;
    EXPECT_EQ(b.snapshots[1].second.attributes.at("state"), "loaded");
    EXPECT_EQ(b.snapshots[1].second.loaded_grain, a.snapshots[1].second.loaded_grain);
    EXPECT_EQ(b.snapshots[1].second.applied_force.y(), -0.2);
    EXPECT_LT(
        difference_of_moves(a.snapshots[0].second, a.snapshots[1].second, b.snapshots[1].second),
        0.01)
        << disks;

    // Told to stop it stays as it was; and so it goes on from a checkpoint.
    stopped->set_watch([](const Progress& p) { return p.phase != "load"; });
    for (int k = 0; k < 10000 && stopped->progress().phase != "load"; ++k) stopped->advance(1000);
    stopped->advance(1000);
    ASSERT_FALSE(stopped->done());
    const FileOfRun file("newton");
    stopped->save(file.path());
    const auto resumed = make_point_load_run(s, 5, 1);
    resumed->restore(file.path());
    expect_same(finished(resumed), b, "resumed");
  }
}

// Newton's method goes on where damped dynamics have brought the energy to rest, and ends where
// they would; on any threads, and stopped on the way, with the same bits.
TEST(PointLoad, ComesToRestByNewtonsMethod) {
  for (const bool disks : {true, false}) {
    PointLoadSetup s = disks ? small("layered") : pentagons();
    s.packing.width = 0.05;
    s.rest.unbalanced_force_ratio = 1e-7;
    s.rest.kinetic_to_elastic_energy = 1e-6;
    s.load.force = 0.2;
    const RunResult a = finished(make_point_load_run(s, 5, 1));
    s.load.rest = "newton";
    const RunResult b = finished(make_point_load_run(s, 5, 1));
    ASSERT_EQ(b.figures.at("rest.by_newton"), 1) << disks;
    EXPECT_EQ(a.figures.count("rest.by_newton"), 0u);
    expect_same(finished(make_point_load_run(s, 5, 2)), b, "on two threads");
    for (const auto& [name, state] : b.snapshots) expect_balanced(state, 1e-7, name);
    EXPECT_LE(b.figures.at("rest.unbalanced_force_ratio"), 1e-8);
    EXPECT_GE(b.figures.at("rest.iterations"), 1);
    EXPECT_LT(b.figures.at("dem.steps"), a.figures.at("dem.steps"));
    EXPECT_GT(b.snapshots[1].second.time, b.snapshots[0].second.time);
    EXPECT_NEAR(b.figures.at("base.weight_ratio"), 1, 1e-6);
    EXPECT_NEAR(b.figures.at("base.response_over_load"), 1, 1e-3);
    const ContactChanges apart = compare_contacts(a.snapshots[0].second, b.snapshots[0].second);
    EXPECT_LT(apart.max_displacement_over_radius, 1e-3);

    const auto stopped = make_point_load_run(s, 5, 1);
    int asked = 0;
    stopped->set_watch([&asked](const Progress& p) {
      asked += p.phase == "rest by Newton's method" ? 1 : 0;
      return p.phase != "rest by Newton's method";
    });
    for (int k = 0; k < 10000 && asked < 2; ++k) stopped->advance(1000);
    ASSERT_EQ(asked, 2);
    const FileOfRun file("rest");
    stopped->save(file.path());
    const auto resumed = make_point_load_run(s, 5, 2);
    resumed->restore(file.path());
    for (int k = 0; k < 3; ++k) {  // and again while the load grows
      resumed->advance(150);
      resumed->save(file.path());
      resumed->restore(file.path());
    }
    expect_same(finished(resumed), b, "resumed");
  }
}

// Tried while grains still fall it fails, and damped dynamics end as without it.
TEST(PointLoad, RestsByDampedDynamicsWhereNewtonsMethodFails) {
  PointLoadSetup s = small("layered");
  s.rest.kinetic_to_elastic_energy = 1e3;
  s.load.force = 0.2;
  const RunResult a = finished(make_point_load_run(s, 5, 1));
  s.load.rest = "newton";
  const auto newton = make_point_load_run(s, 5, 1);
  std::string phases;
  while (!newton->done()) {
    newton->advance(200);
    phases += newton->progress().phase + ";";
  }
  RunResult b = newton->result();
  EXPECT_THAT(phases, testing::HasSubstr("rest (Newton's method failed);"));
  EXPECT_EQ(b.figures.at("rest.by_newton"), 0);
  b.figures.erase("rest.by_newton");
  expect_same(b, a, "damped");
}

std::string refusal(const PointLoadSetup& s) {
  return refusal_of([&] { make_point_load_run(s, 1, 1); });
}

TEST(PointLoad, RefusesWhatCannotBe) {
  PointLoadSetup s = small("layered");
  s.motion.time_step = 1;
  EXPECT_THAT(refusal(s), testing::HasSubstr("motion.time_step: found 1 s, allowed: at most "));
  s = small("layered");
  s.packing.width = 0.001;
  EXPECT_THAT(refusal(s), testing::HasSubstr("packing.width"));
  s = small("layered");
  s.packing.radius_max = 0.001;
  EXPECT_THAT(refusal(s), testing::HasSubstr("packing.radius_max"));
  s = small("triangular");
  s.packing.sizes = "uniform";
  EXPECT_THAT(refusal(s), testing::HasSubstr("packing.sizes"));
  s = small("triangular");
  s.packing.shape = "irregular";
  EXPECT_THAT(refusal(s),
              testing::HasSubstr("packing.shape: found irregular, allowed: disk, regular, "));
  s = pentagons();
  s.packing.side = 0;
  EXPECT_THAT(refusal(s), testing::HasSubstr("packing.side: found 0, allowed: above 0"));
  s = small("layered");
  s.load.rest = "newton";
  s.motion.energy_balance = true;
  EXPECT_THAT(refusal(s), testing::HasSubstr("load.rest: found \"newton\" with motion.energy"));
  s = small("triangular");
  s.material.gravity = 0;
  EXPECT_THAT(refusal(s), testing::HasSubstr("material.gravity"));
}

TEST(PointLoad, SaysWhenItDoesNotComeToRest) {
  PointLoadSetup s = small("triangular");
  s.rest.max_time = 0.01;
  EXPECT_THAT(failure_of(make_point_load_run(s, 1, 1)), testing::HasSubstr("rest.max_time"));
}

TEST(Packing, LatticesTouchWithoutOverlap) {
  for (const char* kind : {"triangular", "sqrt3"}) {
    for (const char* floor : {"smooth", "rough"}) {
      PackingSetup p = small(kind).packing;
      p.floor = floor;
      Random random(1);
      GrainSupply supply(p, random);
      std::vector<NewGrain> all = floor_grains(p, supply, 1, random);
      const std::size_t fixed = all.size();
      for (const NewGrain& g : lattice_grains(p, 1, random)) all.push_back(g);
      const double d = 2 * p.radius;
      int touching = 0, on_floor = 0;
      for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t j = i + 1; j < all.size(); ++j) {
          const double gap = std::hypot(all[i].x - all[j].x, all[i].y - all[j].y) - d;
          EXPECT_GT(gap, -1e-9 * d) << kind << " " << floor;
          if (i >= fixed && gap < 1e-9 * d) ++touching;
          if (i < fixed && j >= fixed && gap < 1e-9 * d) ++on_floor;
        }
        EXPECT_LE(std::fabs(all[i].x) + p.radius, 0.5 * layer_width(p) * (1 + 1e-9));
      }
      // 8 x 4: rows of 8, 7, 8, 7 (or 7, 8, 7, 8 in the hollows of a rough floor).
      const bool triangular = std::string(kind) == "triangular";
      // In the sqrt(3) lattice rows two apart lie straight above each other at exactly d.
      EXPECT_EQ(touching, triangular ? 14 * 3 + 7 + 6 + 7 + 6 : 14 * 3 + 8 + 7);
      EXPECT_EQ(on_floor, fixed > 0 ? (triangular ? 14 : 14 + 8) : 0);
    }
  }
}

TEST(ContactChanges, CountsGainedLostAndSliding) {
  Snapshot a;
  a.grains.resize(4);
  for (int k = 0; k < 4; ++k) {
    a.grains[k].id = k;
    a.grains[k].radius = 1;
  }
  Contact c;
  const auto contact = [&c](int i, int j, bool sliding) {
    c.i = i;
    c.j = j;
    c.sliding = sliding;
    return c;
  };
  Snapshot b = a;
  a.contacts = {contact(0, 1, false), contact(0, 2, false), contact(1, 2, true)};
  b.contacts = {contact(0, 2, true), contact(1, 2, true), contact(1, 3, false),
                contact(2, 3, false)};
  b.grains[2].position.x() = 0.5;
  const ContactChanges changes = compare_contacts(a, b);
  EXPECT_EQ(changes.gained, 2);
  EXPECT_EQ(changes.lost, 1);
  EXPECT_EQ(changes.newly_sliding, 1);
  EXPECT_DOUBLE_EQ(changes.max_displacement_over_radius, 0.5);
  // A radius that a file had rounded.
  b.grains[1].radius *= 1 + 1e-9;
  EXPECT_EQ(compare_contacts(a, b).gained, 2);
  b.grains[1].radius *= 1.001;
  EXPECT_THROW(compare_contacts(a, b), std::invalid_argument);
  b.grains[1].radius = a.grains[1].radius;
  b.grains.pop_back();
  EXPECT_THROW(compare_contacts(a, b), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::dem
