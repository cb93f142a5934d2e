// Rectangles about slender grains: they never part what touches, nor what may touch before the next
// search.
#include "dem/shapes/bounding_rectangle.h"

#include <gmock/gmock.h>

#include "tests/dem/polygon_engine_scene.h"
#include "tests/dem/polygon_scene.h"

namespace grainfield::dem {
namespace {

BoundingRectangle rectangle_about(const Placed& shape, double gap) {
  const auto [ux, uy] = long_axis_of(shape.corners());
  return bounding_rectangle(shape.shape(), ux, uy, gap);
}

TEST(BoundingRectangle, LongAxisOfATurnedEllipse) {
  for (const double ratio : {1.6, 2.0, 10.0}) {
    for (const double turn : {0.0, 0.3, 1.5, 2.9, -1.0}) {
      Outline outline;
      for (const auto& [x, y] : regular(24, 1)) {
        const double c = std::cos(turn), s = std::sin(turn);
        outline.push_back({c * x - s * y / ratio, s * x + c * y / ratio});
      }
      const auto [ux, uy] = long_axis_of(outline);
      EXPECT_NEAR(std::fabs(ux * std::cos(turn) + uy * std::sin(turn)), 1, 1e-12);
    }
  }
}

TEST(BoundingRectangle, RoundGrainsHaveNone) {
  const std::array<double, 2> none = {0, 0};
  EXPECT_EQ(long_axis_of({}), none);
  EXPECT_EQ(long_axis_of(box(1, 1)), none);
  EXPECT_EQ(long_axis_of(box(1.45, 1)), none);
  EXPECT_NE(long_axis_of(box(1.55, 1)), none);
  for (int corners = 3; corners < 12; ++corners) EXPECT_EQ(long_axis_of(regular(corners, 1)), none);
}

TEST(BoundingRectangle, BarsArePartedByTheirGaps) {
  const Placed bar(box(10, 1), 0, 0, 0.4);
  const auto beside = [&](double along, double across) {
    return Placed(box(10, 1), along * std::cos(0.4) - across * std::sin(0.4),
                  along * std::sin(0.4) + across * std::cos(0.4), 0.4);
  };
  const double gap = 0.1;
  const BoundingRectangle a = rectangle_about(bar, gap);
  EXPECT_FALSE(apart(a, rectangle_about(beside(0, 1.199), gap)));
  EXPECT_TRUE(apart(a, rectangle_about(beside(0, 1.201), gap)));
  EXPECT_FALSE(apart(a, rectangle_about(beside(10.199, 0.5), gap)));
  EXPECT_TRUE(apart(a, rectangle_about(beside(10.201, 0.5), gap)));
  // A disk beside it; disk and disk are never further apart than their circles.
  const auto disk = [&](double x, double y) {
    return bounding_rectangle(Placed::disk(1, x, y).shape(), 0, 0, gap);
  };
  EXPECT_FALSE(apart(a, disk(-1.699 * std::sin(0.4), 1.699 * std::cos(0.4))));
  EXPECT_TRUE(apart(a, disk(-1.701 * std::sin(0.4), 1.701 * std::cos(0.4))));
  EXPECT_FALSE(apart(disk(0, 0), disk(2.19, 0)));
}

// Whatever the two do within their gaps: moved by d and turned by w about the centroid, with
// d + radius w at most the gap.
TEST(BoundingRectangle, NothingPartedTouchesWithinTheGaps) {
  Random random(7);
  int parted = 0, overlapping = 0;
  for (int k = 0; k < 60000; ++k) {
    const auto [a, first] = random_pair(random, k % 2 == 0 ? 2 : k);
    const double away = k % 3 == 0 ? 0 : random.uniform(0, 1);
    const Placed b = first.moved(away * first.cx(), away * first.cy(), random.uniform(0, 6.28),
                                 first.cx(), first.cy());
    const double gap_a = 0.2 * a.radius() * random.uniform(),
                 gap_b = 0.2 * b.radius() * random.uniform();
    const bool overlap = overlap_of(a, b).area > 0;
    if (overlap) ++overlapping;
    if (!apart(rectangle_about(a, gap_a), rectangle_about(b, gap_b))) continue;
    ++parted;
    ASSERT_FALSE(overlap) << "pair " << k;
    const auto wander = [&](const Placed& p, double gap, double towards) {
      const double turn = gap / p.radius() * random.uniform(), sign = k % 4 < 2 ? 1 : -1;
      const double step = gap - turn * p.radius();
      return p.moved(step * std::cos(towards), step * std::sin(towards), sign * turn, p.cx(),
                     p.cy());
    };
    const double towards = std::atan2(b.cy() - a.cy(), b.cx() - a.cx());
    for (int trial = 0; trial < 4; ++trial) {
      const double scatter = random.uniform(-1.5, 1.5);
      const Placed a2 = wander(a, gap_a, towards + scatter);
      const Placed b2 = wander(b, gap_b, towards + std::numbers::pi + scatter);
      ASSERT_FALSE(overlap_of(a2, b2).area > 0) << "pair " << k << ", moved";
    }
  }
  EXPECT_GT(parted, 8000);
  EXPECT_GT(overlapping, 20000);
}

// Without damping every overlap carries force: the engine's contacts must be the pairs that
// overlap. Returns their number.
std::size_t expect_all_contacts(const Snapshot& s) {
  std::vector<Placed> placed;
  for (const Grain& g : s.grains) {
    placed.push_back(g.outline.empty()
                         ? Placed::disk(g.radius, g.position.x(), g.position.y())
                         : Placed(g.outline, g.position.x(), g.position.y(), g.angle));
  }
  std::vector<std::pair<std::int64_t, std::int64_t>> expected, found;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    for (std::size_t j = i + 1; j < placed.size(); ++j) {
      if (overlap_of(placed[i], placed[j]).area > 1e-14) expected.emplace_back(i, j);
    }
  }
  for (const Contact& c : s.contacts) {
    if (c.j >= 0) found.emplace_back(c.i, c.j);
  }
  EXPECT_THAT(found, testing::IsSupersetOf(expected)) << "t = " << s.time;
  return found.size();
}

EngineSettings lively_settings(int threads) {
  EngineSettings settings = polygon_settings(threads);
  settings.law = OverlapAreaLaw{1e6, 0};
  settings.friction = 0.3;
  settings.time_step = 1e-5;
  return settings;
}

NewGrain bar_of(double length, double width) {
  NewGrain bar;
  bar.density = 5000;
  bar.outline = box(length, width);
  return bar;
}

// Only turning brings them together: no centroid moves before they touch.
TEST(BoundingRectangle, EngineSeesABarThatTurnsInPlace) {
  EngineSettings weightless = lively_settings(1);
  weightless.gravity_y = 0;
  for (const double spin : {0.7, 5.0, 20.0, -60.0, 300.0}) {
    for (const bool fixed : {false, true}) {
      auto engine = make_engine(weightless);
      NewGrain bar = bar_of(0.02, 0.002);
      bar.fixed = fixed;
      engine->add(bar);
      bar.fixed = false;
      bar.y = 0.0035;
      bar.spin = spin;
      engine->add(bar);
      std::size_t contacts = 0;
      for (int look = 0; look < 3000 && contacts < 5; ++look) {
        engine->step(std::max(1L, std::lround(10 / std::fabs(spin))));
        contacts += expect_all_contacts(engine->snapshot());
        ASSERT_FALSE(HasFailure()) << "spin " << spin;
      }
      EXPECT_GT(contacts, 0) << "spin " << spin;
    }
  }
}

// Two bars fly at each other, side to side or end to end, from distances about the way that the
// search allows: half of it would miss their first steps of contact.
TEST(BoundingRectangle, EngineSeesFastBarsFromAnyDistance) {
  EngineSettings weightless = lively_settings(1);
  weightless.gravity_y = 0;
  for (const bool ends : {false, true}) {
    for (int k = 1; k <= 60; ++k) {
      auto engine = make_engine(weightless);
      NewGrain bar = bar_of(0.02, 0.002);
      for (const double side : {-1.0, 1.0}) {
        const double away = 1e-4 * k;  // in 100 steps they come 2e-3 nearer
        bar.x = ends ? side * (0.01 + away / 2) : 0;
        bar.y = ends ? 0 : side * (0.001 + away / 2);
        (ends ? bar.vx : bar.vy) = -side;
        engine->add(bar);
      }
      std::size_t contacts = 0;
      for (int look = 0; look < 400; ++look) {
        engine->step(1);
        contacts += expect_all_contacts(engine->snapshot());
        ASSERT_FALSE(HasFailure()) << "from " << k;
      }
      EXPECT_GT(contacts, 0U);
    }
  }
}

// A lively crowd of bars, disks and round polygons between walls, a fixed plate among them.
std::unique_ptr<Engine> crowd(const EngineSettings& settings) {
  auto engine = make_engine(settings);
  Random random(11);
  const double cell = 0.024, width = 8 * cell;
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
  engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.2});
  engine->add_wall({"right", {width, 0, 0}, {-1, 0, 0}, 0.2});
  NewGrain plate = bar_of(0.08, 0.005);
  plate.fixed = true;
  plate.x = 0.5 * width;
  plate.y = 0.004;
  plate.angle = 0.2;
  engine->add(plate);
  for (int k = 0; k < 64; ++k) {
    NewGrain g = polygon_grain(random, (k % 8 + 0.5) * cell, 0.04 + (k / 8) * cell, 0.008);
    if (k % 3 != 0) g.outline = random_outline(random, 8, 0.011, random.uniform(2, 12));
    if (k % 9 == 0) {
      g.outline.clear();
      g.radius = 0.007;
    }
    g.vx = random.uniform(-1, 1);
    g.spin = random.uniform(-300, 300);
    engine->add(g);
  }
  return engine;
}

// Looked at after every step: a margin that is too small misses a contact for a few steps only.
TEST(BoundingRectangle, EngineMissesNoContactInACrowd) {
  const auto engine = crowd(lively_settings(1));
  std::size_t contacts = 0;
  for (int look = 0; look < 12000; ++look) {
    engine->step(1);
    contacts += expect_all_contacts(engine->snapshot());
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(contacts, 40000U);
}

// While some sleep: the bits of an uninterrupted run on one thread, whatever the threads, and
// through restarts that find the slender grains again.
TEST(BoundingRectangle, CrowdHasTheSameBitsOnAnyThreadsAndAfterRestarts) {
  const auto settings = [](int threads) {
    EngineSettings s = polygon_settings(threads, true);
    s.time_step = 1e-5;
    return s;
  };
  std::vector<std::string> checkpoints;
  int slept = 0;
  for (const int threads : {1, 2, 3}) {
    auto engine = crowd(settings(threads));
    for (int part = 0; part < 40; ++part) {
      engine->step(1500);
      slept = std::max(slept, engine->grains() - engine->measure().awake);
      if (threads != 2) continue;
      const std::string checkpoint = engine->checkpoint();
      engine = crowd(settings(1));
      engine->restore(checkpoint);
    }
    checkpoints.push_back(engine->checkpoint());
  }
  EXPECT_GT(slept, 20);
  EXPECT_EQ(checkpoints[1], checkpoints[0]);
  EXPECT_EQ(checkpoints[2], checkpoints[0]);
}

}  // namespace
}  // namespace grainfield::dem
