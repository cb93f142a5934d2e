// What pairs of superellipsoids remember to save work: that it changes nothing.
#include "dem/shapes/superellipsoid_store.h"

#include <gmock/gmock.h>

#include <cstring>

#include "tests/dem/superellipsoid_scene.h"

namespace grainfield::dem {
namespace {

using Eigen::Vector3d;

/// Two bodies that fly past each other and tumble.
struct Passing {
  SuperellipsoidStore store;
  std::array<Body<3>, 2> bodies;
  std::array<RotationOf<3>, 2> turns;

  Passing(Random& random, double least, double most) {
    for (int k = 0; k < 2; ++k) {
      const Superellipsoid shape = random_superellipsoid(random, least, most);
      bodies[k].radius =
          store.add({0, {}, {shape.axes.x(), shape.axes.y(), shape.axes.z()}, shape.exponents})
              .radius;
      bodies[k].spin = random.uniform(0, 2) * random_direction(random);
      turns[k] = random_rotation(random);
    }
    const Vector3d way = random_direction(random);
    const double reach = bodies[0].radius + bodies[1].radius;
    bodies[1].position = 1.2 * reach * way + 0.4 * random_direction(random);
    bodies[1].velocity = -way;
    place();
  }
  void place() {
    for (int k = 0; k < 2; ++k) store.place(k, bodies[k], turns[k]);
  }
  void move(double dt) {
    for (int k = 0; k < 2; ++k) {
      bodies[k].position += dt * bodies[k].velocity;
      turns[k] = quaternion_of(dt * bodies[k].spin) * turns[k];
    }
    place();
  }
};

// 400 pairs that come together, overlap and part again, by small and by large steps. Beside the
// pair that waits while it cannot touch, one that looks each time, from the same normal.
TEST(SuperellipsoidStore, NoContactIsMissedWhileAPairWaits) {
  int waited = 0, looked = 0, touched = 0;
  for (const double dt : {2e-3, 0.05}) {
    for (const auto& [least, most] : {std::pair(0.7, 1.3), {0.1, 1.9}}) {
      Random random(11);
      for (int k = 0; k < 100; ++k) {
        Passing pair(random, least, most);
        PairNormal memory;
        for (double t = 0; t < 4; t += dt) {
          pair.move(dt);
          PairNormal anew = memory;
          anew.clear = std::numeric_limits<double>::infinity();
          const PairNormal before = memory;
          Overlap3 o, fresh;
          const auto overlap = [&](PairNormal& feature, Overlap3& out) {
            return pair.store.overlap<Measures::curvatures>(0, pair.bodies[0], 1, pair.bodies[1],
                                                            feature, out);
          };
          const bool touches = overlap(memory, o);
          ASSERT_EQ(touches, overlap(anew, fresh));
          if (touches) {
            ++touched;
            EXPECT_EQ(o.depth, fresh.depth);
            EXPECT_EQ(o.normal, fresh.normal);
          } else if (!before.empty() && before.touching == 0) {
            const bool waits = memory.clear == before.clear && std::isfinite(memory.clear);
            (waits ? waited : looked) += 1;
          }
        }
      }
    }
  }
  EXPECT_GT(touched, 10000);
  EXPECT_GT(waited, 10 * looked);
}

// A pair left out by the ways of both does not touch, and would remember what it does.
TEST(SuperellipsoidStore, APairLeftOutWouldNotTouchNorChange) {
  int left_out = 0, looked = 0;
  for (const double dt : {2e-3, 0.02}) {
    for (const auto& [least, most] : {std::pair(0.7, 1.3), {0.1, 1.9}}) {
      Random random(13);
      for (int k = 0; k < 100; ++k) {
        Passing pair(random, least, most);
        PairNormal memory;
        double until = 0;
        for (double t = 0; t < 4; t += dt) {
          pair.move(dt);
          PairNormal now = memory;
          Overlap3 o;
          const bool touches = pair.store.overlap<Measures::curvatures>(0, pair.bodies[0], 1,
                                                                        pair.bodies[1], now, o);
          if (pair.store.ways()[0] + pair.store.ways()[1] < until) {
            ++left_out;
            ASSERT_FALSE(touches);
            EXPECT_EQ(std::memcmp(&now, &memory, sizeof now), 0);
            continue;
          }
          looked += touches ? 0 : 1;
          memory = now;
          until = touches ? 0
                          : pair.store.apart_until(0, pair.bodies[0], 1, pair.bodies[1].position,
                                                   memory);
        }
      }
    }
  }
  EXPECT_GT(left_out, 3 * looked);
}

// Powers that follow by their series from step to step, against those taken anew, at the normal
// that the former has found.
TEST(SuperellipsoidStore, PowersThatFollowAreThoseTakenAnew) {
  for (const auto& [least, most, bound] : {std::tuple(0.7, 1.3, 1e-12), {0.1, 1.9, 1e-11}}) {
    Random random(12);
    double worst = 0, curvature = 0;
    int compared = 0;
    for (int k = 0; k < 100; ++k) {
      Passing pair(random, least, most);
      PairNormal memory;
      for (double t = 0; t < 4; t += 2e-3) {
        pair.move(2e-3);
        PairNormal anew = memory;
        anew.powers = {};
        Overlap3 o, fresh;
        const bool touches = pair.store.overlap<Measures::curvatures>(0, pair.bodies[0], 1,
                                                                      pair.bodies[1], memory, o);
        const bool also = pair.store.overlap<Measures::curvatures>(0, pair.bodies[0], 1,
                                                                   pair.bodies[1], anew, fresh);
        if (!touches || !also) {
          EXPECT_LT(touches ? o.depth : also ? fresh.depth : 0, bound);
          continue;
        }
        ++compared;
        worst = std::max(worst, std::fabs(o.depth - fresh.depth));
        curvature =
            std::max(curvature, std::fabs(o.greater_curvature / fresh.greater_curvature - 1));
      }
    }
    EXPECT_GT(compared, 10000);
    EXPECT_LT(worst, bound) << least;
    EXPECT_LT(curvature, 1e-6) << least;
  }
}

}  // namespace
}  // namespace grainfield::dem
