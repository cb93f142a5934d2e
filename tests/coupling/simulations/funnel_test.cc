// A point source between immobile plates.
#include "dem/pouring/funnel.h"

#include <gmock/gmock.h>

#include <cmath>

#include "coupling/studies/pile/pile_checks.h"
#include "coupling/studies/pile/simulation.h"
#include "dem/grains/grain_family.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon.h"
#include "tests/coupling/finished_run.h"

namespace grainfield::dem {
namespace {

PileSetup funnel_pile(double opening) {
  PileSetup s = small_pile("point", "rand1");
  s.source.grains = 30;
  s.source.interval = 0.2;
  s.source.opening = opening;
  return s;
}

TEST(Funnel, PlatesLeaveTheMouthOpen) {
  SourceSetup s;
  EXPECT_TRUE(funnel_plates(s, 1).empty());
  s.height = 2;
  s.opening = 0.3;
  const std::vector<NewGrain> plates = funnel_plates(s, 1);
  ASSERT_EQ(plates.size(), 2u);
  for (const double side : {-1.0, 1.0}) {
    const NewGrain& p = plates[side < 0 ? 0 : 1];
    EXPECT_TRUE(p.fixed);
    EXPECT_GT(area_of(p.outline), 0);  // counter-clockwise
    const auto [cx, cy] = centroid_of(p.outline);
    EXPECT_NEAR(cx, 0, 1e-15);
    EXPECT_NEAR(cy, 0, 1e-15);
    // The corner nearest the axis is the mouth's edge, the face above it rises at 60 degrees.
    double inner = 1e9, low = 1e9, high = -1e9;
    for (const auto& [x, y] : p.outline) {
      inner = std::min(inner, side * (p.x + x));
      low = std::min(low, p.y + y);
      high = std::max(high, p.y + y);
      EXPECT_GE(side * (p.x + x) + 1e-12, 0.15 + (p.y + y - 2) / std::sqrt(3));
    }
    EXPECT_NEAR(inner, 0.15, 1e-15);
    EXPECT_NEAR(low, 2, 1e-15);
    EXPECT_NEAR(high, 2 + funnel_rise(s), 1e-15);
  }
  EXPECT_NEAR(funnel_half_width(s), 0.15 + funnel_rise(s) / std::sqrt(3), 1e-15);
}

// Grains that start beside the mouth come down through it, with a push from the plates, and the
// pile stands on the floor alone.
TEST(Funnel, GrainsComeDownThroughTheMouth) {
  PileSetup s = funnel_pile(0.14);
  s.floor.length = 6;
  const RunResult r = finished(make_pile_run(s, 3, 1));
  const Snapshot& pile = r.snapshots[0].second;
  int plates = 0;
  for (const Grain& g : pile.grains) {
    plates += g.fixed ? 1 : 0;
    if (g.fixed) continue;
    EXPECT_LT(g.position.y(), 0.6);
  }
  EXPECT_EQ(plates, 2);
  EXPECT_NEAR(r.figures.at("base.weight_ratio"), 1, 1e-3);
  for (const Contact& c : pile.contacts) {
    EXPECT_FALSE(pile.grains[c.i].fixed);
    EXPECT_TRUE(c.j < 0 || !pile.grains[c.j].fixed);
  }
}

// More grains than the mouth lets through fill the funnel, and the run says so.
TEST(Funnel, AnOverfilledFunnelEndsTheRun) {
  PileSetup s = funnel_pile(0.14);
  s.source.grains = 400;
  s.source.height = 2;
  s.floor.length = 6;
  s.source.interval = 0.02;
  s.source.speed = 4;
  s.material.friction = 2;
  const std::string said = failure_of(make_pile_run(s, 4, 1));
  EXPECT_THAT(said, testing::HasSubstr("stuck in the funnel"));
  EXPECT_THAT(said, testing::HasSubstr("raise source.opening, now 0.14 m"));
}

// Wherever a grain starts between the plates, it leaves by the mouth.
TEST(Funnel, EveryGrainLeavesByTheMouth) {
  SourceSetup source;
  source.opening = 0.14;
  source.height = 1;
  ShapeSetup shape;
  shape.radius = 0.0275;
  Random random(7);
  for (int k = 0; k < 60; ++k) {
    EngineSettings settings;
    settings.friction = 0.54;
    settings.shape = ShapeKind::polygon;
    const auto engine = make_engine(settings);
    for (const NewGrain& plate : funnel_plates(source, 5000)) engine->add(plate);
    const ShapedGrain grain = draw_grain(shape, random);
    const double room = funnel_room(source, grain.radius);
    // The first at the limits on either side.
    const double x = k < 2 ? (2 * k - 1) * room : random.uniform(-room, room);
    engine->add(grain.at(x, source.height + funnel_rise(source), 5000));
    engine->step(1);
    EXPECT_EQ(engine->measure().contacts, 0) << k;
    double mouth = 1e9;
    for (int chunk = 0; chunk < 2000 && engine->snapshot().grains[2].position.y() > 0.9; ++chunk) {
      engine->step(100);
      const Snapshot now = engine->snapshot();
      if (now.grains[2].position.y() < source.height) {
        mouth = std::min(mouth, std::fabs(now.grains[2].position.x()));
      }
    }
    EXPECT_LT(mouth, 0.5 * source.opening) << k;
  }
}

TEST(Funnel, RefusesWhatCannotBe) {
  const auto refusal = [](const PileSetup& s) -> std::string {
    try {
      make_pile_run(s, 1, 1);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal(funnel_pile(0.14)), "accepted");
  EXPECT_THAT(refusal(funnel_pile(-1)), testing::HasSubstr("source.opening: found -1, allowed: 0"));
  EXPECT_THAT(
      refusal(funnel_pile(0.06)),
      testing::HasSubstr("source.opening: found 0.06, allowed: 0 (no funnel) or at least "));
  PileSetup s = funnel_pile(0.14);
  s.source.move = 0.1;
  EXPECT_THAT(refusal(s), testing::HasSubstr("source.move: found 0.1, allowed: 0 with a funnel"));
  s = funnel_pile(0.14);
  s.source.spread = 2;
  EXPECT_THAT(refusal(s), testing::HasSubstr("source.spread: found 2, allowed: 0.5 with a funnel"));
  s.source.spread = 0.5;
  s.floor.length = 0.6;
  s.source.grains = 3;
  EXPECT_THAT(refusal(s), testing::HasSubstr("source.opening: found 0.14, allowed: a funnel ("));
  s = small_pile("line", "disk");
  s.source.opening = 0.1;
  EXPECT_THAT(refusal(s), testing::HasSubstr("source.opening: found 0.1, allowed: 0 with source"));
}

TEST(Funnel, SaysWhenGrainsAreStuck) {
  const PileSetup s = funnel_pile(0.14);
  Snapshot now;
  now.grains.resize(2);
  now.grains[0].fixed = true;  // a plate
  now.grains[0].position.y() = 1.2;
  now.grains[1].position.y() = 0.99;
  EXPECT_NO_THROW(check_funnel_empty(s, now));
  now.grains[1].position.y() = 1.01;
  try {
    check_funnel_empty(s, now);
    FAIL();
  } catch (const ComputationFailed& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("1 grain is stuck in the funnel after the pour; "
                                                 "raise source.opening, now 0.14 m"));
  }
  // A slow grain on a plate is not the pile's top.
  Contact c;
  c.i = 1;
  c.j = 0;
  now.contacts.push_back(c);
  EXPECT_EQ(resting_top(now, 10), 0);
  // Nor is one that lies on another stuck there, or on the pile above the mouth.
  now.grains.push_back(now.grains[1]);
  now.contacts[0].j = 2;
  EXPECT_EQ(resting_top(now, 10), 0);
  c.i = 2;
  c.j = -1;
  now.contacts.push_back(c);
  EXPECT_GT(resting_top(now, 10), 1);
  EXPECT_EQ(resting_top(now, 1), 0);
  EXPECT_NO_THROW(check_not_waiting(s, 1.9));
  EXPECT_NO_THROW(check_not_waiting(small_pile("point", "disk"), 100));
  EXPECT_THROW(check_not_waiting(s, 2.1), ComputationFailed);
}

}  // namespace
}  // namespace grainfield::dem
