// The pile study: balance, restart to the same bits, any number of threads, changes of gravity.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "coupling/studies/pile/simulation.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/coupling/finished_run.h"
#include "tests/dem/imbalance.h"

namespace grainfield::dem {
namespace {

TEST(Pile, BaseCarriesTheWeight) {
  for (const char* shape : {"disk", "rand1"}) {
    for (const char* source : {"point", "line"}) {
      const PileSetup s = small_pile(source, shape);
      const auto run = make_pile_run(s, 3, 1);
      const RunResult r = finished(run);
      EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-3) << shape << " " << source;
      expect_balanced(r.snapshots[0].second, 1e-3, std::string(shape) + " " + source);
      EXPECT_EQ(r.figures.at("dem.grains") + r.figures.at("pile.grains_not_poured"), 80);
      ASSERT_EQ(r.snapshots.size(), 1u);
      EXPECT_EQ(r.snapshots[0].first, "pile");
      EXPECT_EQ(r.snapshots[0].second.attributes.at("source"), source);
      EXPECT_GT(r.figures.at("pile.height"), 5 * s.shape.radius);
      const Progress p = run->progress();
      EXPECT_EQ(p.fraction, 1);
      EXPECT_EQ(p.phase, "done");
    }
  }
}

TEST(Pile, RecordsItselfWhileItGrows) {
  for (const char* source : {"point", "line"}) {
    PileSetup s = small_pile(source, "rand1");
    const auto plain = make_pile_run(s, 3, 1);
    finish(*plain);
    s.record = {20, 50};
    const RunResult r = finished(make_pile_run(s, 3, 1));
    ASSERT_EQ(r.snapshots.size(), 3u) << source;
    EXPECT_TRUE(same(r.snapshots[0].second, plain->result().snapshots[0].second)) << source;
    const Snapshot& pile = r.snapshots[0].second;
    double time = 0;
    for (const std::size_t k : {1u, 2u}) {
      const auto& [name, early] = r.snapshots[k];
      const std::size_t least = k == 1 ? 20 : 50;
      EXPECT_EQ(name, fmt::format("poured_{}", least));
      EXPECT_FALSE(is_change(name));
      EXPECT_GE(early.grains.size(), least) << source;
      EXPECT_LT(early.grains.size(), least + (source == std::string("point") ? 1 : 20)) << source;
      EXPECT_GT(early.time, time);
      time = early.time;
      for (std::size_t g = 0; g < early.grains.size(); ++g) {
        EXPECT_EQ(early.grains[g].id, pile.grains[g].id);
      }
    }
    EXPECT_GT(pile.time, time);
  }
}

TEST(Pile, FunnelMovesAndDropsOneGrainPerInterval) {
  PileSetup s = small_pile("point", "disk");
  s.source.move = 1.5;
  const RunResult r = finished(make_pile_run(s, 3, 1));
  EXPECT_GT(r.figures.at("pile.pour_time"), 79 * s.source.interval);
  EXPECT_LT(r.figures.at("pile.pour_time"), 79 * s.source.interval + 0.5);
  const Snapshot& pile = r.snapshots[0].second;
  std::size_t first = 0;
  while (pile.grains[first].fixed) ++first;
  // The early grains lie further to the left than the late ones.
  double early = 0, late = 0;
  for (int k = 0; k < 20; ++k) {
    early += pile.grains[first + k].position.x() / 20;
    late += pile.grains[pile.grains.size() - 1 - k].position.x() / 20;
  }
  EXPECT_LT(early, -0.2);
  EXPECT_GT(late, 0.2);
}

PileSetup with_changes(const std::string& source, const std::string& shape) {
  PileSetup s = small_pile(source, shape);
  s.source.grains = 20;
  s.source.interval = 0.11;
  s.source.length = 0.7;
  s.source.height = 0.6;
  s.rest.unbalanced_force_ratio = 1e-2;
  s.rest.kinetic_to_elastic_energy = 1e-3;
  s.change.method = "damped";
  s.change.gravity = {5, 8.829};
  s.change.ramp_time = 0.05;
  return s;
}

TEST(Pile, SameBitsOnAnyNumberOfThreads) {
  for (const char* shape : {"rand1"}) {
    for (const char* source : {"point", "line"}) {
      RunResult first;
      for (const int threads : {1, 2, 3}) {
        const RunResult r = finished(make_pile_run(with_changes(source, shape), 5, threads));
        ASSERT_EQ(r.snapshots.size(), 3u);
        if (threads == 1) first = r;
        expect_same(r, first, fmt::format("{} {} {} threads", shape, source, threads));
      }
    }
  }
}

TEST(Pile, ResumesToTheSameBitsFromAnyStep) {
  const FileOfRun file("pile");
  Random random(1);
  for (const char* shape : {"disk", "rand1"}) {
    for (const char* source : {"point", "line"}) {
      PileSetup s = with_changes(source, shape);
      s.record = {5, 15};
      const auto whole = make_pile_run(s, 9, 1);
      long total = 0;
      while (!whole->done()) {
        whole->advance(1000);
        total += 1000;
      }
      SCOPED_TRACE(fmt::format("{} {}", shape, source));
      const auto make = [&](int threads) { return make_pile_run(s, 9, threads); };
      expect_same_after_stops(make, whole->result(), static_cast<double>(total), 3, file, random);
      PileSetup changed = s;
      changed.source.spread = 0.25;
      EXPECT_THROW(make_pile_run(changed, 9, 1)->restore(file.path()), std::invalid_argument);
      EXPECT_THROW(make_pile_run(s, 10, 1)->restore(file.path()), std::invalid_argument);
      std::filesystem::resize_file(file.path(), std::filesystem::file_size(file.path()) / 2);
      EXPECT_THROW(make(1)->restore(file.path()), std::invalid_argument);
    }
  }
}

TEST(Pile, EveryChangeOfGravityStartsFromThePile) {
  PileSetup s = with_changes("point", "disk");
  // The base carries the weight but for the grains' resultants: 20 of them, each this share of a
  // contact force of a few weights.
  s.rest.unbalanced_force_ratio = 3e-4;
  s.rest.kinetic_to_elastic_energy = 1e-4;
  const RunResult r = finished(make_pile_run(s, 2, 1));
  s.change.gravity = {8.829};
  const RunResult one = finished(make_pile_run(s, 2, 1));
  ASSERT_EQ(r.snapshots[2].first, "gravity_8.829");
  EXPECT_TRUE(same(r.snapshots[2].second, one.snapshots[1].second));
  const double weight = base_force(r.snapshots[0].second).y();
  EXPECT_EQ(r.snapshots[1].second.gravity.y(), -5);
  EXPECT_NEAR(base_force(r.snapshots[1].second).y() / weight, 5 / 9.81, 1e-3);
  EXPECT_NEAR(base_force(r.snapshots[2].second).y() / weight, 0.9, 1e-3);
  EXPECT_GT(r.figures.at("change.gravity_5.max_displacement_over_radius"), 1e-6);
}

// The quasi-static solver against slow damped dynamics: where no contact rearranges both find the
// same state.
TEST(Pile, NewtonAgreesWithDampedDynamics) {
  PileSetup s = with_changes("line", "rand1");
  s.change.gravity = {9.7};
  s.change.ramp_time = 0.3;
  s.rest.unbalanced_force_ratio = 1e-7;
  s.rest.kinetic_to_elastic_energy = 1e-13;
  const RunResult a = finished(make_pile_run(s, 4, 1));
  s.change.method = "newton";
  const RunResult b = finished(make_pile_run(s, 4, 1));
  ASSERT_EQ(b.snapshots.size(), 2u);
  EXPECT_EQ(b.snapshots[1].first, "gravity_9.7");
  EXPECT_EQ(b.snapshots[1].second.attributes.at("state"), "gravity_9.7");
  expect_balanced(b.snapshots[1].second, 1e-8);
  ASSERT_TRUE(same(a.snapshots[0].second, b.snapshots[0].second));
  ASSERT_EQ(a.figures.at("change.gravity_9.7.contacts_lost"), 0);
  EXPECT_LT(
      difference_of_moves(a.snapshots[0].second, a.snapshots[1].second, b.snapshots[1].second),
      0.01);
}

// A solve that is told to stop leaves the run as it was, and the run goes on to the same bits.
TEST(Pile, NewtonStopsWhenToldTo) {
  PileSetup s = with_changes("line", "rand1");
  s.change.gravity = {9.7};
  s.change.method = "newton";
  const RunResult whole = finished(make_pile_run(s, 4, 1));
  const auto stopped = make_pile_run(s, 4, 1);
  int asked = 0;
  stopped->set_watch([&](const Progress& p) {
    EXPECT_EQ(p.phase, "gravity_9.7");
    return ++asked > 3;
  });
  for (int k = 0; k < 100000 && asked < 3; ++k) stopped->advance(1000);
  ASSERT_EQ(asked, 3);
  EXPECT_FALSE(stopped->done());
  expect_same(finished(stopped), whole, "stopped");
}

}  // namespace
}  // namespace grainfield::dem
