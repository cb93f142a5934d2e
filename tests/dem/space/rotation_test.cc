// Sine and cosine of the engine against the library's.
#include "dem/space/rotation.h"

#include <gmock/gmock.h>

#include "dem/random/random.h"

namespace grainfield::dem {
namespace {

TEST(Rotation, AgreesWithTheLibrary) {
  Random random(1);
  for (int k = 0; k < 200000; ++k) {
    const double range = k % 3 == 0 ? 1e-3 : k % 3 == 1 ? 10 : 1e5;
    const double angle = random.uniform(-range, range);
    const Rotation r = rotation_of(angle);
    ASSERT_NEAR(r.cosine, std::cos(angle), 3e-16) << angle;
    ASSERT_NEAR(r.sine, std::sin(angle), 3e-16) << angle;
  }
  for (int k = -40; k <= 40; ++k) {  // where the reduction changes sign and quadrant
    const double angle = k * 0.78539816339744830962;
    ASSERT_NEAR(rotation_of(angle).cosine, std::cos(angle), 3e-16) << k;
    ASSERT_NEAR(rotation_of(angle).sine, std::sin(angle), 3e-16) << k;
  }
}

TEST(Rotation, ExactAtZeroAndNanForNan) {
  EXPECT_EQ(rotation_of(0).cosine, 1);
  EXPECT_EQ(rotation_of(0).sine, 0);
  EXPECT_TRUE(std::isnan(rotation_of(std::nan("")).cosine));
}

}  // namespace
}  // namespace grainfield::dem
