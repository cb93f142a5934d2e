// What the pile study refuses, and what it says when a pile does not stand.
#include <gmock/gmock.h>

#include <cmath>

#include "coupling/studies/pile/pile_checks.h"
#include "coupling/studies/pile/simulation.h"
#include "dem/run/common.h"
#include "tests/coupling/pile_scene.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

std::string refusal(const PileSetup& s) {
  return refusal_of([&] { make_pile_run(s, 1, 1); });
}

TEST(Pile, RefusesWhatCannotBe) {
  using testing::HasSubstr;
  EXPECT_EQ(refusal(small_pile("point", "disk")), "accepted");
  PileSetup s = small_pile("point", "disk");
  s.motion.time_step = 1;
  EXPECT_THAT(refusal(s), HasSubstr("motion.time_step: found 1 s, allowed: at most "));
  s = small_pile("point", "disk");
  s.shape.polydispersity = 1;
  EXPECT_THAT(refusal(s), HasSubstr("shape.polydispersity"));
  s = small_pile("point", "disk");
  s.material.gravity = 0;
  EXPECT_THAT(refusal(s), HasSubstr("material.gravity"));
  for (const std::vector<double>& record : {std::vector{20.5}, {30.0, 20.0}, {20.0, 81.0}}) {
    s = small_pile("point", "disk");
    s.record = record;
    EXPECT_THAT(refusal(s), HasSubstr("allowed: whole numbers of grains up to source.grains = 80"));
  }
  s = small_pile("point", "disk");
  s.source.interval = 0.02;
  EXPECT_THAT(refusal(s), HasSubstr("source.interval: found 0.02, allowed: at least 0.102 s"));
  EXPECT_THAT(refusal(s), HasSubstr("raise source.interval or source.speed"));
  s = small_pile("point", "disk");
  s.source.height = 0.3;
  EXPECT_THAT(refusal(s), HasSubstr("source.height: found 0.3, allowed: at least 0."));
  EXPECT_THAT(refusal(s), HasSubstr("raise source.height or lower source.grains"));
  s = small_pile("point", "disk");
  s.floor.length = 1;
  EXPECT_THAT(refusal(s), HasSubstr("floor.length: found 1, allowed: at least 1."));
  EXPECT_THAT(refusal(s), HasSubstr("runs off its floor; raise floor.length"));
  s = small_pile("line", "disk");
  s.source.length = 0.5;
  EXPECT_THAT(refusal(s), HasSubstr("source.length: found 0.5, allowed: at least"));
  s = small_pile("point", "disk");
  s.change.gravity = {5, 5};
  EXPECT_THAT(refusal(s), HasSubstr("change.gravity: found 5, allowed: every value once"));
}

// A key that would change nothing is refused, and a floor too short for the line blames the line.
TEST(Pile, RefusesWhatHasNoEffect) {
  PileSetup s = small_pile("point", "regular");
  s.shape.axis_ratio = 2;
  EXPECT_THAT(refusal(s),
              testing::HasSubstr("shape.axis_ratio: found 2, allowed: 1, because only"));
  s = small_pile("point", "disk");
  s.shape.outline = {0, 0, 1, 0, 0, 1};
  EXPECT_THAT(refusal(s), testing::HasSubstr("shape.outline: found 6 numbers, allowed: none"));
  s = small_pile("point", "disk");
  s.source.shift = 0.1;
  EXPECT_THAT(refusal(s),
              testing::HasSubstr("source.shift: found 0.1, allowed: 0 with source.kind"));
  // Layers beside one another, beyond the walls in the end.
  s = small_pile("line", "disk");
  s.source.shift = 0.6 * s.source.length;
  EXPECT_THAT(refusal(s), testing::HasSubstr("allowed: at most half of source.length"));
  s = small_pile("line", "disk");
  s.source.move = 0.1;
  EXPECT_THAT(refusal(s),
              testing::HasSubstr("source.move: found 0.1, allowed: 0 with source.kind"));
  s = small_pile("line", "disk");
  s.source.length = 3.9;
  s.floor.length = 4;
  EXPECT_THAT(refusal(s),
              testing::HasSubstr("m for source.length = 3.9 m; raise floor.length or lower"));
}

// The value that a message names is accepted.
TEST(Pile, RemediesHelp) {
  PileSetup s = small_pile("point", "disk");
  s.source.interval = s.source.height = s.floor.length = 1e-3;
  PileSetup line = small_pile("line", "disk");
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
    PileSetup s = small_pile("point", shape);
    if (s.shape.kind == "outline") s.shape.outline = {-1, -1, 1, -1, 1, 1, -1, 1};
    s.motion.time_step_fraction = fraction;
    s.motion.integrator = integrator;
    return refusal(s);
  };
  for (const char* shape : {"disk", "regular", "outline"}) {
    EXPECT_EQ(with(shape, 1), "accepted") << shape;
    EXPECT_THAT(
        with(shape, 1.01),
        HasSubstr("motion.time_step_fraction: found 1.01, allowed: at most 1 (the stable "
                  "limit) for grains of this shape and material with verlet; only shape.kind"))
        << shape;
  }
  for (const char* shape : {"rand1", "irregular"}) {
    EXPECT_EQ(with(shape, 2), "accepted") << shape;
    EXPECT_THAT(with(shape, 3), HasSubstr("motion.time_step_fraction: found 3, allowed")) << shape;
    EXPECT_EQ(with(shape, 1, "gear"), "accepted") << shape;
    EXPECT_THAT(with(shape, 2, "gear"), HasSubstr("found 2, allowed: at most 1")) << shape;
  }
  // Nearly round ones are bounded by the dashpots of round grains, of which half is the limit.
  PileSetup round = small_pile("point", "rand1");
  round.shape.corners_min = round.shape.corners_max = 40;
  round.motion.time_step_fraction = 2.4;
  EXPECT_THAT(refusal(round), HasSubstr("found 2.4, allowed: at most 2 for irregular polygons"));
  round.motion.time_step_fraction = 2;
  EXPECT_EQ(refusal(round), "accepted");
}

TEST(Pile, LimitsOfTheSourceAreTheClosedForms) {
  for (const double share : {1.01, 0.99}) {
    PileSetup s = small_pile("point", "disk");
    s.shape.polydispersity = 0;
    // v t + g t^2/2 = 2 r.
    const double v = s.source.speed, g = s.material.gravity;
    s.source.interval = share * (std::sqrt(v * v + 2 * g * 0.055) - v) / g;
    EXPECT_EQ(refusal(s) == "accepted", share > 1) << refusal(s);
    s = small_pile("point", "disk");
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
  PileSetup s = small_pile("line", "disk");
  s.rest.max_time = 0.001;
  s.rest.unbalanced_force_ratio = 1e-9;
  const auto run = make_pile_run(s, 1, 1);
  EXPECT_THAT(failure(*run), testing::HasSubstr("no rest within rest.max_time = 0.001 s (after"));
  s = small_pile("line", "rand1");
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
  PileSetup s = small_pile("line", "disk");
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

TEST(PileChecks, RestHasComeAsFarAsTheMeasureThatLags) {
  RestSetup rest;
  rest.unbalanced_force_ratio = 1e-6;
  rest.kinetic_to_elastic_energy = 1e-10;
  Diagnostics d;
  d.elastic_energy = 1;
  const auto progress = [&](double force, double energy) {
    d.unbalanced_force_ratio = force;
    d.kinetic_energy = energy;
    return rest_progress(d, rest);
  };
  EXPECT_NEAR(progress(1e-3, 1e-12), 0.5, 1e-12);
  EXPECT_NEAR(progress(1e-7, 1e-4), 0.4, 1e-12);  // forces balance, grains still swing
  EXPECT_EQ(progress(1e-7, 1e-12), 1);
  EXPECT_EQ(progress(10, 10), 0);
}

TEST(PileChecks, WhileThePileGrows) {
  PileSetup s = small_pile("point", "disk");
  EXPECT_EQ(failed_check([&] { check_mouth(s, 0.88, 0.055); }), "passed");
  EXPECT_THAT(failed_check([&] { check_mouth(s, 0.9, 0.055); }),
              testing::HasSubstr("has reached the mouth of the source at source.height = 1 m"));
  EXPECT_EQ(failed_check([&] { check_line_long_enough(s, 65); }), "passed");
  EXPECT_THAT(failed_check([&] { check_line_long_enough(s, 63); }),
              testing::HasSubstr("came to a point after 63 of 80 grains"));
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

// A share of the weight, and strays; of few grains not more than five thousandths.
TEST(PileChecks, LeaningIsMoreThanStrays) {
  for (const int n : {100, 3000}) {
    Snapshot s;
    s.gravity = Vec3(0, -10, 0);
    s.walls.push_back({"left", Vec3(0, 0, 0), Vec3(1, 0, 0), 0});
    s.grains.resize(n);
    for (Grain& g : s.grains) g.mass = 1;
    s.contacts.resize(1);
    s.contacts[0].j = -1;
    const double allowed = n == 100 ? 5e-3 : 2e-3;
    const PileSetup setup = small_pile("point", "disk");
    s.contacts[0].force = Vec3(0.99 * allowed * 10 * n, 0, 0);
    EXPECT_EQ(failed_check([&] { check_not_leaning(setup, s); }), "passed");
    s.contacts[0].force = Vec3(1.01 * allowed * 10 * n, 0, 0);
    EXPECT_THAT(failed_check([&] { check_not_leaning(setup, s); }),
                testing::HasSubstr("leans on the side walls with"));
  }
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
  EXPECT_EQ(resting_top(s, 1), 0);       // nothing stands on the floor
  c.i = 0;
  c.j = -1;
  s.contacts.push_back(c);
  EXPECT_DOUBLE_EQ(resting_top(s, 1), 0.04);
  EXPECT_EQ(resting_top(Snapshot{}, 1), 0);
}

}  // namespace
}  // namespace grainfield::dem
