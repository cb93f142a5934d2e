// The servo of a cell against a medium with a modulus and a viscosity.
#include "dem/run/cell_servo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace grainfield::dem {
namespace {

constexpr double kStiff = 1e7, kTarget = 1e4;  // Pa

// Its pressure p answers to the rate r of an edge: p = e - eta r, de/dt = -M r + drift.
struct Medium {
  double modulus = 0, viscosity = 0, drift = 0;
  double elastic = 0, rate = 0;

  double pressure() const { return elastic - viscosity * rate; }
  void go_on(double next, double time) {
    rate = next;
    elastic += (drift - modulus * rate) * time;
  }
};

CellServo servo() {
  CellServo s;
  s.modulus = kStiff;
  s.slowness = 1e-4;
  s.interval = 1e-4;
  s.most = 1;
  return s;
}

TEST(CellServo, ReachesItsTargetWithoutSwinging) {
  // From a packing at rest to one that answers with all that the servo knows of.
  for (const double share : {0.1, 0.25, 0.5, 1.0}) {
    CellServo s = servo();
    Medium medium{share * kStiff, share * kStiff * s.slowness, 0, 1.1 * kTarget, 0};
    double lowest = 1, last = 1;
    for (int k = 0; k < 2000; ++k) {
      medium.go_on(s.rate(0, medium.pressure(), kTarget), s.interval);
      last = (medium.pressure() - kTarget) / (0.1 * kTarget);
      lowest = std::min(lowest, last);
    }
    EXPECT_GT(lowest, -0.4) << share;  // what the bias has to give back
    EXPECT_LT(std::fabs(last), 1e-6) << share;
  }
}

TEST(CellServo, LeavesNoErrorWhereTheMediumDilatesSteadily) {
  CellServo s = servo();
  Medium medium{0.25 * kStiff, 0, 1e5, kTarget, 0};
  double most = 0;
  for (int k = 0; k < 5000; ++k) {
    medium.go_on(s.rate(1, medium.pressure(), kTarget), s.interval);
    most = std::max(most, std::fabs(medium.pressure() / kTarget - 1));
  }
  EXPECT_NEAR(s.bias[1], medium.drift / medium.modulus, 1e-9);
  EXPECT_LT(std::fabs(medium.pressure() / kTarget - 1), 1e-8);
  EXPECT_GT(most, 1e-4);  // before the bias had learnt it
  s.forget();
  EXPECT_EQ(s.bias[1], 0);
}

// What it has learnt near the target does not hold an error far from it.
TEST(CellServo, GivesBackWhatIsAgainstTheError) {
  CellServo s = servo();
  s.most = 10;
  Medium medium{0.25 * kStiff, 0, 0, 1.5 * kTarget, 0};
  const double answer = 0.5 * kTarget / (kStiff * (s.interval + s.slowness));
  s.bias[0] = -answer;
  EXPECT_NEAR(s.rate(0, medium.pressure(), kTarget), answer / 20, 1e-12 * answer);
  for (int k = 0; k < 2000; ++k) {
    medium.go_on(s.rate(0, medium.pressure(), kTarget), s.interval);
  }
  EXPECT_LT(std::fabs(medium.pressure() / kTarget - 1), 1e-3);
  // ... and what is with it neither grows nor goes.
  s.bias[0] = 1;
  s.rate(0, 2 * kTarget, kTarget);
  EXPECT_EQ(s.bias[0], 1);
}

TEST(CellServo, NeverAsksForMoreThanItMay) {
  CellServo s = servo();
  EXPECT_EQ(s.rate(0, 1e9, kTarget), 1);
  EXPECT_EQ(s.rate(0, 0, 1e9), -1);
  EXPECT_EQ(s.bias[0], 0);  // far from the target it learns nothing
}

}  // namespace
}  // namespace grainfield::dem
