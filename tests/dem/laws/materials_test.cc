// Several materials: law and friction by pair, and what is refused.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/dem/bits_scene.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;

EngineSettings two_materials() {
  EngineSettings s;
  s.materials = {"steel", "glass"};
  s.material_pairs = {{"steel", "steel", LinearLaw{4e6, 1e6, 0, 0}, 0.1},
                      {"glass", "steel", LinearLaw{1e6, 3e5, 0, 0}, 0.4},
                      {"glass", "glass", LinearLaw{2.5e5, 1e5, 0, 0}, 0.9}};
  s.gravity_y = 0;
  s.time_step = 1e-6;
  return s;
}

NewGrain disk(const std::string& material, double x, double vx) {
  NewGrain g;
  g.x = x;
  g.y = 0.01;
  g.vx = vx;
  g.radius = 0.01;
  g.density = 1000;
  g.material = material;
  return g;
}

// Time for which two disks that meet head-on touch, s.
double contact_time(const std::string& first, const std::string& second) {
  const auto engine = make_engine(two_materials());
  engine->add(disk(first, 0, 0.1));
  engine->add(disk(second, 0.020001, -0.1));
  long touching = 0;
  for (int k = 0; k < 3000; ++k) {
    engine->step(1);
    touching += engine->measure().contacts;
  }
  EXPECT_EQ(engine->measure().contacts, 0);
  return static_cast<double>(touching) * engine->time_step();
}

TEST(Materials, EachPairHasItsStiffness) {
  const double mass = 1000 * std::numbers::pi * 1e-4;
  const auto expected = [&](double k) { return std::numbers::pi * std::sqrt(0.5 * mass / k); };
  // Two steps of contact may be cut at either end.
  EXPECT_NEAR(contact_time("steel", "steel"), expected(4e6), 3e-6);
  EXPECT_NEAR(contact_time("steel", "glass"), expected(1e6), 3e-6);
  EXPECT_NEAR(contact_time("glass", "steel"), expected(1e6), 3e-6);
  EXPECT_NEAR(contact_time("glass", "glass"), expected(2.5e5), 3e-6);
}

// Blocks that slide on a wall come to a stop after v^2 / (2 mu g).
TEST(Materials, WallsHaveOneToo) {
  EngineSettings s = two_materials();
  s.gravity_y = -9.81;
  s.time_step = 1e-5;
  const auto way = [&](const std::string& grain, const std::string& wall) {
    const auto engine = make_engine(s);
    engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.25}, wall);
    NewGrain g = disk(grain, 0, 1);
    g.rotates = false;
    engine->add(g);
    engine->set_background_damping(0);
    engine->step(150000);
    const double x = engine->snapshot().grains[0].position.x();
    engine->step(1000);
    EXPECT_NEAR(engine->snapshot().grains[0].position.x(), x, 1e-4);
    return x;
  };
  const auto expected = [](double mu) { return 1 / (2 * mu * 9.81); };
  // It is dropped by less than the overlap at rest, and bounces on: 2 %.
  EXPECT_NEAR(way("steel", "glass"), expected(0.4), 0.02 * expected(0.4));
  EXPECT_NEAR(way("glass", "glass"), expected(0.9), 0.02 * expected(0.9));
  EXPECT_NEAR(way("steel", ""), expected(0.25), 0.02 * expected(0.25));
}

TEST(Materials, SmallestStepOfAllPairsCounts) {
  EngineSettings s = two_materials(), steel;
  steel.law = LinearLaw{4e6, 1e6, 0, 0};
  EXPECT_EQ(stable_time_step(s, 0.3), stable_time_step(steel, 0.3));
}

TEST(Materials, AreTheSameOnThreadsAndAfterARestart) {
  const auto run = [&](int threads, bool cut) {
    EngineSettings s = two_materials();
    s.gravity_y = -9.81;
    s.time_step = 1e-5;
    s.threads = threads;
    const auto box = [&] {
      auto engine = make_engine(s);
      engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0}, "glass");
      engine->add_wall({"side", {0.2, 0, 0}, {-1, 0, 0}, 0.3});
      return engine;
    };
    auto engine = box();
    for (int k = 0; k < 30; ++k) {
      NewGrain g = disk(k % 3 == 0 ? "steel" : "glass", 0.0201 * (k % 6) + 0.001 * (k / 6), 0.2);
      g.y = 0.011 + 0.02 * (k / 6);
      engine->add(g);
    }
    engine->step(2000);
    if (cut) {
      const std::string checkpoint = engine->checkpoint();
      engine = box();
      engine->restore(checkpoint);
    }
    engine->step(2000);
    return bits::hash_of(engine->snapshot());
  };
  const std::uint64_t one = run(1, false);
  EXPECT_EQ(one, run(3, false));
  EXPECT_EQ(one, run(1, true));
}

TEST(Materials, RefusalsSayWhatIsMissing) {
  EXPECT_THAT(refusal_of([] { make_engine(two_materials())->add(disk("stell", 0, 0)); }),
              AllOf(HasSubstr("\"stell\""), HasSubstr("steel, glass"),
                    HasSubstr("did you mean \"steel\"?")));
  EXPECT_THAT(refusal_of([] { make_engine(EngineSettings{})->add(disk("steel", 0, 0)); }),
              HasSubstr("no materials are named"));
  EngineSettings s = two_materials();
  s.material_pairs.erase(s.material_pairs.begin() + 1);
  const auto mixed = [&] {
    const auto engine = make_engine(s);
    engine->add(disk("steel", 0, 0));
    engine->add(disk("glass", 1, 0));
  };
  EXPECT_THAT(refusal_of(mixed), HasSubstr("material pair glass - steel: found none"));
  const auto on_wall = [&] {
    const auto engine = make_engine(s);
    engine->add(disk("steel", 0, 0));
    engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0}, "glass");
  };
  EXPECT_THAT(refusal_of(on_wall), HasSubstr("material pair steel - glass: found none"));
  const auto made = [](const auto& change) {
    EngineSettings changed = two_materials();
    change(changed);
    return refusal_of([&] { make_engine(changed); });
  };
  EXPECT_THAT(made([](auto& e) { e.material_pairs[1].friction = -1; }),
              HasSubstr("material pair glass - steel: found -1, allowed: 0 or more"));
  EXPECT_THAT(made([](auto& e) { e.material_pairs[1].first = "steel"; }), HasSubstr("found twice"));
  EXPECT_THAT(made([](auto& e) { e.material_pairs[1].law = OverlapAreaLaw{}; }),
              HasSubstr("found law \"overlap_area\", allowed: \"linear\""));
  EXPECT_THAT(made([](auto& e) { e.material_pairs[1].first = "wood"; }), HasSubstr("\"wood\""));
  EXPECT_THAT(made([](auto& e) { e.materials[1] = "steel"; }), HasSubstr("names that differ"));
}

}  // namespace
}  // namespace grainfield::dem
