// When bodies in flight meet: against places along their ways.
#include <gtest/gtest.h>

#include "dem/collisions/flight.h"
#include "dem/random/random.h"
#include "dem/space/space3.h"

namespace grainfield::dem {
namespace {

template <int D>
VectorOf<D> random_vector(Random& random, double size) {
  VectorOf<D> out;
  for (int a = 0; a < D; ++a) out[a] = random.uniform(-size, size);
  return out;
}

TEST(HardFlight, FallsToAPlane) {
  EXPECT_DOUBLE_EQ(fall_time(1, -2, 0), 0.5);
  EXPECT_DOUBLE_EQ(fall_time(2, 0, -1), 2);
  EXPECT_DOUBLE_EQ(fall_time(1.5, 1, -1), 3);
  EXPECT_DOUBLE_EQ(fall_time(0, 1, -2), 1);  // thrown up from it
  EXPECT_DOUBLE_EQ(fall_time(1.5, -2, 1), 1);
  EXPECT_EQ(fall_time(3, -2, 1), kNever);  // turned round before
  EXPECT_EQ(fall_time(1, 1, 0), kNever);
  EXPECT_EQ(fall_time(0, 0, 0), kNever);
  EXPECT_EQ(fall_time(0, 0, -1), 0);
  EXPECT_EQ(fall_time(-1e-16, -1, 5), 0);  // behind it by round-off
  EXPECT_EQ(fall_time(-1e-16, 1, 0), kNever);
  EXPECT_NEAR(fall_time(-1e-16, 1e-9, -1), 1e-9, 1e-15);  // cannot rise out of it
  EXPECT_NEAR(fall_time(-1e-16, 1e-7, -1), 2e-7, 2e-9);
  EXPECT_EQ(fall_time(std::numeric_limits<double>::infinity(), -1, 0), kNever);
}

// At the time told they are at their distance and come nearer, and nowhere before.
template <int D>
void expect_first_meeting(bool same_acceleration) {
  Random random(8);
  int met = 0;
  for (int k = 0; k < 3000; ++k) {
    VectorOf<D> r = random_vector<D>(random, 3);
    if (r.norm() < 1.01) continue;
    const VectorOf<D> u = random_vector<D>(random, 2), v = random_vector<D>(random, 2);
    VectorOf<D> a = VectorOf<D>::Zero();
    if (!same_acceleration) a = random_vector<D>(random, 2);
    const double time = same_acceleration ? meet_time(r, u, v, 1.0) : meet_time(r, u, v, a, 1.0);
    const auto gap = [&](double t) { return (r + t * (v - u) + 0.5 * t * t * a).norm() - 1; };
    const double end = std::min(time, 20.0);
    for (int s = 1; s < 400; ++s) ASSERT_GT(gap(end * s / 400), -1e-12) << k;
    if (time == kNever) continue;
    ++met;
    EXPECT_NEAR(gap(time), 0, 1e-12) << k;
    EXPECT_LT((r + time * (v - u) + 0.5 * time * time * a).dot(v - u + time * a), 0) << k;
  }
  EXPECT_GT(met, 100);
}

TEST(HardFlight, PairsMeetFirst) {
  expect_first_meeting<2>(true);
  expect_first_meeting<3>(true);
  expect_first_meeting<2>(false);
  expect_first_meeting<3>(false);
}

// The stated rule of round-off.
TEST(HardFlight, TouchingPairsMeetAtOnceOrNever) {
  using V = VectorOf<2>;
  const V still(0, 0), way(1 - 1e-15, 0), force(-1, 0);
  EXPECT_EQ(meet_time(way, still, V(-1, 0), 1.0), 0);
  EXPECT_EQ(meet_time(way, still, V(1, 0), 1.0), kNever);
  EXPECT_EQ(meet_time(way, still, V(0, 3), 1.0), kNever);
  EXPECT_EQ(meet_time(way, V(1, 0), V(1 - 1e-16, 0), 1.0), kNever);  // round-off of 1
  EXPECT_EQ(meet_time(way, still, V(-1e-9, 0), 1.0), 0);
  EXPECT_EQ(meet_time(way, still, still, 1.0), kNever);
  // Different accelerations: up and back.
  EXPECT_NEAR(meet_time(way, still, V(1, 0), force, 1.0), 2, 1e-12);
  EXPECT_EQ(meet_time(way, still, still, force, 1.0), 0);
  EXPECT_EQ(meet_time(way, still, still, V(-force), 1.0), kNever);
}

}  // namespace
}  // namespace grainfield::dem
