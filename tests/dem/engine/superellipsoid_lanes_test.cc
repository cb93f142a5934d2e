// Pairs, forces and turning side by side (lane_width.h): the bits of one by one, at every width.
#include <gmock/gmock.h>

#include "tests/dem/at_lane_width.h"
#include "tests/dem/bits_scene.h"
#include "tests/dem/superellipsoid_lanes_scene.h"

namespace grainfield::dem {
namespace {

class SuperellipsoidLanes : public AtLaneWidth {};

// As the engine had it pair by pair, before there were lanes.
TEST_P(SuperellipsoidLanes, ScenesEndAsPairByPair) {
  const std::array<std::uint64_t, 4> known{0xdd2dc0824e65957e, 0xe9e1c51f21a1638f,
                                           0x1b6f55372a819129, 0xd3230022151b142f};
  for (int k = 0; k < 4; ++k) {
    for (const int threads : {1, 2}) {
      LanesScene scene{k / 2 == 1, HertzEllipticLaw{1e5, 0.3, 0.3}, threads, false};
      if (k % 2 == 1) scene.law = PenaltyLaw{1e4, 5e3, 0.3};
      const auto engine = lanes_scene(scene);
      engine->step(400);
      EXPECT_EQ(bits::hash_of(engine->snapshot()), known[k]) << k << ", threads " << threads;
    }
  }
}

// An energy balance asks for the law contact by contact, a step alone begins grain by grain; what
// shares a batch changes with the threads.
TEST_P(SuperellipsoidLanes, LawAndTurningAreThoseOneByOne) {
  for (const AnyLaw& law :
       {AnyLaw(HertzEllipticLaw{1e5, 0.3, 0.3}), AnyLaw(PenaltyLaw{1e4, 5e3, 0.3})}) {
    for (const bool cell : {false, true}) {
      const auto run = [&](bool alone, int threads) {
        const auto engine = lanes_scene({cell, law, threads, alone});
        for (int k = 0; k < (alone ? 200 : 1); ++k) engine->step(alone ? 1 : 200);
        EXPECT_GT(engine->measure().contacts, 60);
        return bits::hash_of(engine->snapshot());
      };
      const std::uint64_t alone = run(true, 1);
      for (const int threads : {1, 2, 3}) EXPECT_EQ(run(false, threads), alone) << cell << threads;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, SuperellipsoidLanes, testing::Values(2, 4, 8));

}  // namespace
}  // namespace grainfield::dem
