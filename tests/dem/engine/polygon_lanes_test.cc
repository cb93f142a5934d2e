// Outlines placed side by side (place_lanes.h): the bits of one by one, at every width.
#include <gtest/gtest.h>

#include <vector>

#include "dem/random/random.h"
#include "dem/shapes/polygon_store.h"
#include "dem/space/lane_width.h"
#include "tests/dem/bits_scene.h"
#include "tests/dem/cell_scene.h"
#include "tests/dem/polygon_engine_scene.h"

namespace grainfield::dem {
namespace {

// The width that was there is there again behind a test.
struct Width {
  const int before = lane_width();
  ~Width() { use_lane_width(before); }
};

void place_both_ways(Random& random, double largest) {
  constexpr int count = 77;  // more than a batch of any width, and no multiple
  PolygonStore one, all;
  std::vector<Body<2>> bodies(count);
  std::vector<double> angles(3 * count);
  std::vector<int> list;
  for (int i = 0; i < count; ++i) {
    Outline outline;
    if (i % 7 != 3) outline = scattered_polygon(random, 0.01, 3 + i % 11);
    const ShapeInput shape{0.01, outline};
    one.add(shape);
    all.add(shape);
    bodies[i].position = {random.uniform(-1, 1), random.uniform(-1, 1)};
    bodies[i].radius = 0.01;
    angles[3 * i] = random.uniform(-1, 1) * (largest > 1 && i % 5 == 0 ? 1e5 : largest);
    if (i % 10 != 0) list.push_back(i);
  }
  for (const int i : list) one.place(i, bodies[i], angles[3 * i]);
  for (const int width : {2, 4, 8}) {
    if (!use_lane_width(width)) continue;
    PolygonStore placed = all;
    placed.place_all(list.data(), static_cast<int>(list.size()), bodies.data(), angles.data(), 3);
    for (int i = 0; i < count; ++i) {
      const PlacedShape a = one.placed(i, bodies[i]), b = placed.placed(i, bodies[i]);
      ASSERT_EQ(a.n, b.n);
      for (int k = 0; k <= a.n && a.n > 0; ++k) {
        ASSERT_EQ(a.x[k], b.x[k]) << width << " lanes, grain " << i;
        ASSERT_EQ(a.y[k], b.y[k]) << width << " lanes, grain " << i;
      }
    }
  }
}

TEST(PolygonLanes, CornersAreThoseOfOneByOne) {
  const Width kept;
  Random random(5);
  // Where all angles of some lanes are below 0.004, a shorter series serves (lane_angle.h).
  for (int n = 0; n < 20; ++n) {
    for (const double largest : {10.0, 0.3, 0.05, 0.02, 0.0039, 1e-8}) {
      place_both_ways(random, largest);
    }
  }
}

// Polygons and disks among them that fall, touch, slide and fall asleep, by one thread and two;
// with an energy balance, too, which asks for pair by pair.
TEST(PolygonLanes, StepsHaveTheSameBits) {
  const Width kept;
  for (const bool sleep : {false, true}) {
    std::vector<std::uint64_t> hashes;
    for (const int width : {2, 4, 8}) {
      if (!use_lane_width(width)) continue;
      for (const int threads : {1, 2}) {
        EngineSettings settings = polygon_settings(threads, sleep);
        settings.energy_balance = threads == 2 && width == 4;
        auto engine = polygon_box(settings, 12, 10);
        engine->step(4000);
        hashes.push_back(bits::hash_of(engine->snapshot()));
      }
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
  }
}

// Polygons of up to seven corners, pressed together, in a cell that shears.
TEST(PolygonLanes, StepsInACellHaveTheSameBits) {
  const Width kept;
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero();
  shear(0, 1) = 2;
  EngineSettings settings =
      cells::settings_of(ShapeKind::polygon, cells::cell_of(2, {0, 0, 0}, cells::square(1), shear));
  settings.law = OverlapAreaLaw{1e4, 0.75};
  const auto grains = cells::block(ShapeKind::polygon, settings.cell, 10, 3);
  std::vector<std::uint64_t> hashes;
  for (const int width : {2, 4, 8}) {
    if (!use_lane_width(width)) continue;
    for (const int threads : {1, 3}) {
      settings.threads = threads;
      auto engine = make_engine(settings);
      for (const NewGrain& grain : grains) engine->add(grain);
      engine->step(1500);
      EXPECT_GT(engine->measure().contacts, 100);
      hashes.push_back(bits::hash_of(engine->snapshot()));
    }
  }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
}

}  // namespace
}  // namespace grainfield::dem
