// The pile study: balance, restart to the same bits, any number of threads, and what it refuses.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "dem/random/random.h"
#include "dem/study/contact_changes.h"
#include "dem/study/pile_checks.h"
#include "dem/study/run.h"

namespace grainfield::dem {
namespace {

// Grains ten times Roul's, so that a step is ten times as long.
PileSetup small(const std::string& source, const std::string& shape) {
  PileSetup s;
  s.shape.kind = shape;
  s.shape.radius = 0.0275;
  s.source.kind = source;
  s.source.grains = 80;
  s.source.height = 1;
  s.source.interval = 0.15;
  s.source.length = 1.3;
  s.source.clearance = 0.08;
  s.floor.length = 4;
  s.floor.kind = shape == "disk" ? "rough" : "smooth";  // disks roll away on a flat floor
  // Disks without rolling resistance creep: a modest rest will do.
  s.rest.unbalanced_force_ratio = 1e-3;
  s.rest.kinetic_to_elastic_energy = 1e-4;
  return s;
}

void finish(Run& run) {
  while (!run.done()) run.advance(5000);
}

TEST(Pile, BaseCarriesTheWeight) {
  for (const char* shape : {"disk", "rand1"}) {
    for (const char* source : {"point", "line"}) {
      const PileSetup s = small(source, shape);
      const auto run = make_pile_run(s, 3, 1);
      finish(*run);
      const RunResult r = run->result();
      EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-3) << shape << " " << source;
      EXPECT_LE(r.figures.at("dem.unbalanced_force_ratio"), 1e-3);
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

TEST(Pile, FunnelMovesAndDropsOneGrainPerInterval) {
  PileSetup s = small("point", "disk");
  s.source.move = 1.5;
  const auto run = make_pile_run(s, 3, 1);
  finish(*run);
  const RunResult r = run->result();
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

bool same(const Snapshot& a, const Snapshot& b) {
  if (a.grains.size() != b.grains.size() || a.contacts.size() != b.contacts.size()) return false;
  for (std::size_t k = 0; k < a.grains.size(); ++k) {
    if (a.grains[k].position != b.grains[k].position || a.grains[k].angle != b.grains[k].angle ||
        a.grains[k].velocity != b.grains[k].velocity ||
        a.grains[k].outline != b.grains[k].outline) {
      return false;
    }
  }
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    if (a.contacts[k].force != b.contacts[k].force ||
        a.contacts[k].spring != b.contacts[k].spring) {
      return false;
    }
  }
  return true;
}

// Same figures, where nan equals nan.
bool same_figures(const RunResult& a, const RunResult& b) {
  if (a.figures.size() != b.figures.size()) return false;
  for (const auto& [key, value] : a.figures) {
    const double other = b.figures.at(key);
    if (value != other && !(std::isnan(value) && std::isnan(other))) return false;
  }
  return true;
}

PileSetup with_changes(const std::string& source, const std::string& shape) {
  PileSetup s = small(source, shape);
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
        const auto run = make_pile_run(with_changes(source, shape), 5, threads);
        finish(*run);
        const RunResult r = run->result();
        ASSERT_EQ(r.snapshots.size(), 3u);
        if (threads == 1) first = r;
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_TRUE(same(r.snapshots[k].second, first.snapshots[k].second))
              << shape << " " << source << " " << threads << " threads";
        }
        EXPECT_TRUE(same_figures(r, first));
      }
    }
  }
}

TEST(Pile, ResumesToTheSameBitsFromAnyStep) {
  const std::string file = (std::filesystem::temp_directory_path() /
                            ("grainfield_pile_" + std::to_string(getpid()) + ".h5"))
                               .string();
  Random random(1);
  for (const char* shape : {"disk", "rand1"}) {
    for (const char* source : {"point", "line"}) {
      const PileSetup s = with_changes(source, shape);
      const auto whole = make_pile_run(s, 9, 1);
      long total = 0;
      while (!whole->done()) {
        whole->advance(1000);
        total += 1000;
      }
      const RunResult expected = whole->result();
      for (int trial = 0; trial < 3; ++trial) {
        const long stop = static_cast<long>(random.uniform() * static_cast<double>(total));
        {
          const auto first = make_pile_run(s, 9, 1 + trial % 2);
          first->advance(stop);
          first->save(file);
        }
        const auto second = make_pile_run(s, 9, 2 - trial % 2);
        second->restore(file);
        finish(*second);
        const RunResult got = second->result();
        ASSERT_EQ(got.snapshots.size(), expected.snapshots.size());
        for (std::size_t k = 0; k < got.snapshots.size(); ++k) {
          EXPECT_TRUE(same(got.snapshots[k].second, expected.snapshots[k].second))
              << shape << " " << source << ": " << got.snapshots[k].first << ", stopped at "
              << stop;
        }
        EXPECT_TRUE(same_figures(got, expected)) << "stopped at " << stop;
      }
      PileSetup changed = s;
      changed.source.spread = 0.25;
      EXPECT_THROW(make_pile_run(changed, 9, 1)->restore(file), std::invalid_argument);
      EXPECT_THROW(make_pile_run(s, 10, 1)->restore(file), std::invalid_argument);
      std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
      EXPECT_THROW(make_pile_run(s, 9, 1)->restore(file), std::invalid_argument);
    }
  }
  std::filesystem::remove(file);
}

TEST(Pile, EveryChangeOfGravityStartsFromThePile) {
  PileSetup s = with_changes("point", "disk");
  // The base carries the weight but for the grains' resultants: 20 of them, each this share of a
  // contact force of a few weights.
  s.rest.unbalanced_force_ratio = 3e-4;
  s.rest.kinetic_to_elastic_energy = 1e-4;
  const auto both = make_pile_run(s, 2, 1);
  finish(*both);
  s.change.gravity = {8.829};
  const auto one = make_pile_run(s, 2, 1);
  finish(*one);
  const RunResult r = both->result();
  ASSERT_EQ(r.snapshots[2].first, "gravity_8.829");
  EXPECT_TRUE(same(r.snapshots[2].second, one->result().snapshots[1].second));
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
  const auto damped = make_pile_run(s, 4, 1);
  finish(*damped);
  s.change.method = "newton";
  const auto newton = make_pile_run(s, 4, 1);
  finish(*newton);
  const RunResult a = damped->result(), b = newton->result();
  ASSERT_EQ(b.snapshots.size(), 2u);
  EXPECT_EQ(b.snapshots[1].first, "gravity_9.7");
  EXPECT_EQ(b.snapshots[1].second.attributes.at("state"), "gravity_9.7");
  EXPECT_LE(b.figures.at("change.gravity_9.7.unbalanced_force_ratio"), 1e-8);
  ASSERT_TRUE(same(a.snapshots[0].second, b.snapshots[0].second));
  ASSERT_EQ(a.figures.at("change.gravity_9.7.contacts_lost"), 0);
  double difference = 0, moved = 0;
  for (std::size_t k = 0; k < a.snapshots[0].second.grains.size(); ++k) {
    const Vec3 before = a.snapshots[0].second.grains[k].position;
    moved += (a.snapshots[1].second.grains[k].position - before).squaredNorm();
    difference +=
        (a.snapshots[1].second.grains[k].position - b.snapshots[1].second.grains[k].position)
            .squaredNorm();
  }
  EXPECT_LT(std::sqrt(difference / moved), 0.01);
}

// A solve that is told to stop leaves the run as it was, and the run goes on to the same bits.
TEST(Pile, NewtonStopsWhenToldTo) {
  PileSetup s = with_changes("line", "rand1");
  s.change.gravity = {9.7};
  s.change.method = "newton";
  const auto whole = make_pile_run(s, 4, 1), stopped = make_pile_run(s, 4, 1);
  finish(*whole);
  int asked = 0;
  stopped->set_watch([&](const Progress& p) {
    EXPECT_EQ(p.phase, "gravity_9.7");
    return ++asked > 3;
  });
  for (int k = 0; k < 100000 && asked < 3; ++k) stopped->advance(1000);
  ASSERT_EQ(asked, 3);
  EXPECT_FALSE(stopped->done());
  finish(*stopped);
  EXPECT_TRUE(same(whole->result().snapshots[1].second, stopped->result().snapshots[1].second));
}

std::string refusal(const PileSetup& s) {
  try {
    make_pile_run(s, 1, 1);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Pile, RefusesWhatCannotBe) {
  using testing::HasSubstr;
  EXPECT_EQ(refusal(small("point", "disk")), "accepted");
  PileSetup s = small("point", "disk");
  s.motion.time_step = 1;
  EXPECT_THAT(refusal(s), HasSubstr("motion.time_step: found 1 s, allowed: at most "));
  s = small("point", "disk");
  s.shape.polydispersity = 1;
  EXPECT_THAT(refusal(s), HasSubstr("shape.polydispersity"));
  s = small("point", "disk");
  s.material.gravity = 0;
  EXPECT_THAT(refusal(s), HasSubstr("material.gravity"));
  s = small("point", "disk");
  s.source.grains = 2;
  EXPECT_THAT(refusal(s), HasSubstr("source.grains: found 2, allowed: 3 or more"));
  s = small("point", "disk");
  s.source.kind = "circle";
  EXPECT_THAT(refusal(s), HasSubstr("source.kind: found \"circle\", allowed: point, line"));
  s = small("point", "disk");
  s.source.interval = 0.02;
  EXPECT_THAT(refusal(s), HasSubstr("source.interval: found 0.02, allowed: at least 0.102 s"));
  EXPECT_THAT(refusal(s), HasSubstr("raise source.interval or source.speed"));
  s = small("point", "disk");
  s.source.height = 0.3;
  EXPECT_THAT(refusal(s), HasSubstr("source.height: found 0.3, allowed: at least 0."));
  EXPECT_THAT(refusal(s), HasSubstr("raise source.height or lower source.grains"));
  s = small("point", "disk");
  s.floor.length = 1;
  EXPECT_THAT(refusal(s), HasSubstr("floor.length: found 1, allowed: at least 1."));
  EXPECT_THAT(refusal(s), HasSubstr("runs off its floor; raise floor.length"));
  s = small("line", "disk");
  s.source.length = 0.5;
  EXPECT_THAT(refusal(s), HasSubstr("source.length: found 0.5, allowed: at least"));
  s = small("point", "disk");
  s.change.gravity = {5, -1};
  EXPECT_THAT(refusal(s), HasSubstr("change.gravity: found -1, allowed: above 0"));
  s.change.gravity = {5, 5};
  EXPECT_THAT(refusal(s), HasSubstr("change.gravity: found 5, allowed: every value once"));
}

// A key that would change nothing is refused, and a floor too short for the line blames the line.
TEST(Pile, RefusesWhatHasNoEffect) {
  PileSetup s = small("point", "regular");
  s.shape.axis_ratio = 2;
  EXPECT_THAT(refusal(s),
              testing::HasSubstr("shape.axis_ratio: found 2, allowed: 1, because only"));
  s = small("point", "disk");
  s.shape.outline = {0, 0, 1, 0, 0, 1};
  EXPECT_THAT(refusal(s), testing::HasSubstr("shape.outline: found 6 numbers, allowed: none"));
  s = small("point", "disk");
  s.source.shift = 0.1;
  EXPECT_THAT(refusal(s),
              testing::HasSubstr("source.shift: found 0.1, allowed: 0 with source.kind"));
  s = small("line", "disk");
  s.source.move = 0.1;
  EXPECT_THAT(refusal(s),
              testing::HasSubstr("source.move: found 0.1, allowed: 0 with source.kind"));
  s = small("line", "disk");
  s.source.length = 3.9;
  s.floor.length = 4;
  EXPECT_THAT(refusal(s),
              testing::HasSubstr("m for source.length = 3.9 m; raise floor.length or lower"));
}

// The value that a message names is accepted.
TEST(Pile, RemediesHelp) {
  PileSetup s = small("point", "disk");
  s.source.interval = s.source.height = s.floor.length = 1e-3;
  PileSetup line = small("line", "disk");
  line.source.length = line.floor.length = 1e-3;
  const auto named = [](const PileSetup& setup, const std::string& key) {
    const std::string text = refusal(setup), before = "allowed: at least ";
    EXPECT_THAT(text, testing::StartsWith(key));
    return std::stod(text.substr(text.find(before) + before.size()));
  };
  s.source.interval = named(s, "source.interval");
  s.source.height = named(s, "source.height");
  s.floor.length = named(s, "floor.length");
  EXPECT_EQ(refusal(s), "accepted");
  line.source.length = named(line, "source.length");
  line.floor.length = named(line, "floor.length");
  EXPECT_EQ(refusal(line), "accepted");
}

// Grains edge on edge in chains are what the limit is made for: regular shapes form them, a given
// outline may; Gear's limit is that of its dashpots.
TEST(Pile, OnlyIrregularPolygonsMayGoAboveTheStableLimit) {
  using testing::HasSubstr;
  const auto with = [](const char* shape, double fraction, const char* integrator = "verlet") {
    PileSetup s = small("point", shape);
    if (s.shape.kind == "outline") s.shape.outline = {-1, -1, 1, -1, 1, 1, -1, 1};
    s.motion.time_step_fraction = fraction;
    s.motion.integrator = integrator;
    return refusal(s);
  };
  for (const char* shape : {"disk", "regular", "outline"}) {
    EXPECT_EQ(with(shape, 1), "accepted") << shape;
    EXPECT_THAT(with(shape, 1.01),
                HasSubstr("motion.time_step_fraction: found 1.01, allowed: at most 1 (the stable "
                          "limit) for verlet with this material; only irregular polygons"))
        << shape;
  }
  for (const char* shape : {"rand1", "irregular"}) {
    EXPECT_EQ(with(shape, 2), "accepted") << shape;
    EXPECT_THAT(with(shape, 3), HasSubstr("motion.time_step_fraction: found 3, allowed")) << shape;
    EXPECT_EQ(with(shape, 1, "gear"), "accepted") << shape;
    EXPECT_THAT(with(shape, 2, "gear"), HasSubstr("found 2, allowed: at most 1")) << shape;
  }
  // Nearly round ones are bounded by the dashpots of round grains, of which half is the limit.
  PileSetup round = small("point", "rand1");
  round.shape.corners_min = round.shape.corners_max = 40;
  round.motion.time_step_fraction = 2.4;
  EXPECT_THAT(refusal(round), HasSubstr("found 2.4, allowed: at most 2 for irregular polygons"));
  round.motion.time_step_fraction = 2;
  EXPECT_EQ(refusal(round), "accepted");
}

TEST(Pile, LimitsOfTheSourceAreTheClosedForms) {
  for (const double share : {1.01, 0.99}) {
    PileSetup s = small("point", "disk");
    s.shape.polydispersity = 0;
    // v t + g t^2/2 = 2 r.
    const double v = s.source.speed, g = s.material.gravity;
    s.source.interval = share * (std::sqrt(v * v + 2 * g * 0.055) - v) / g;
    EXPECT_EQ(refusal(s) == "accepted", share > 1) << refusal(s);
    s = small("point", "disk");
    s.shape.polydispersity = 0;
    const double area = 80 * 3.14159265358979 * 0.0275 * 0.0275 / 0.8;
    s.source.height = share * (std::sqrt(area / std::sqrt(3)) + 4 * 0.0275);
    EXPECT_EQ(refusal(s) == "accepted", share > 1) << refusal(s);
  }
}

std::string failure(Run& run) {
  try {
    finish(run);
  } catch (const ComputationFailed& error) {
    return error.what();
  }
  return "finished";
}

TEST(Pile, SaysWhenItDoesNotComeToRest) {
  PileSetup s = small("line", "disk");
  s.rest.max_time = 0.001;
  s.rest.unbalanced_force_ratio = 1e-9;
  const auto run = make_pile_run(s, 1, 1);
  EXPECT_THAT(failure(*run), testing::HasSubstr("no rest within rest.max_time = 0.001 s (after"));
  s = small("line", "rand1");
  s.source.grains = 20;
  s.source.length = 0.7;
  s.rest.max_time = 0.001;
  s.rest.unbalanced_force_ratio = 1e-9;
  s.motion.time_step_fraction = 2;
  const auto large_step = make_pile_run(s, 1, 1);
  EXPECT_THAT(failure(*large_step),
              testing::EndsWith(", or lower motion.time_step_fraction, now 2"));
}

TEST(Pile, SaysWhenItLeansOnTheWalls) {
  PileSetup s = small("line", "disk");
  s.floor.kind = "smooth";
  s.floor.length = 1.8;
  s.material.floor_friction = 0;  // nothing holds the foot
  const auto run = make_pile_run(s, 1, 1);
  const std::string text = failure(*run);
  EXPECT_THAT(text, testing::HasSubstr("side wall"));
  EXPECT_THAT(text, testing::HasSubstr("raise floor.length, now 1.8 m, to at least"));
}

template <class Check>
std::string failed_check(Check check) {
  try {
    check();
  } catch (const ComputationFailed& error) {
    return error.what();
  }
  return "passed";
}

TEST(PileChecks, WhileThePileGrows) {
  PileSetup s = small("point", "disk");
  EXPECT_EQ(failed_check([&] { check_mouth(s, 0.88, 0.055); }), "passed");
  EXPECT_THAT(failed_check([&] { check_mouth(s, 0.9, 0.055); }),
              testing::HasSubstr("has reached the mouth of the source at source.height = 1 m"));
  EXPECT_EQ(failed_check([&] { check_line_long_enough(s, 75); }), "passed");
  EXPECT_THAT(failed_check([&] { check_line_long_enough(s, 20); }),
              testing::HasSubstr("came to a point after 20 of 80 grains; raise source.length, now "
                                 "1.3 m, to at least 2.6 m"));
  Snapshot wall;
  wall.grains.resize(1);
  wall.grains[0].position = Vec3(-1.98, 0.1, 0);
  EXPECT_EQ(failed_check([&] { check_walls_free(s, wall, 0.055, 0.25); }), "passed");
  // In the air it does not stand.
  wall.grains[0].position.y() = 0.2;
  EXPECT_EQ(failed_check([&] { check_walls_free(s, wall, 0.055, 0.25); }), "passed");
  wall.contacts.resize(1);
  wall.contacts[0].i = 0;
  wall.contacts[0].j = -1;
  EXPECT_THAT(failed_check([&] { check_walls_free(s, wall, 0.055, 0.25); }),
              testing::HasSubstr("after 25 % of source.grains; raise floor.length, now 4 m, to at "
                                 "least 9.6 m"));
}

TEST(PileChecks, RestingTopLeavesOutWhatFlies) {
  Snapshot s;
  s.gravity = Vec3(0, -9.81, 0);
  s.grains.resize(4);
  const double heights[] = {0.01, 0.03, 0.2, 0.3};
  for (int k = 0; k < 4; ++k) {
    s.grains[k].radius = 0.01;
    s.grains[k].position.y() = heights[k];
  }
  Contact c;
  c.i = 0;
  c.j = 1;
  s.contacts.push_back(c);
  c.i = 2;
  s.contacts.push_back(c);
  s.grains[2].velocity = Vec3(0, 2, 0);  // bounces off
  EXPECT_DOUBLE_EQ(resting_top(s), 0.04);
  EXPECT_EQ(resting_top(Snapshot{}), 0);
}

}  // namespace
}  // namespace grainfield::dem
