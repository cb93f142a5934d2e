#include "dem/run/cell_servo.h"

#include <algorithm>
#include <cmath>

namespace grainfield::dem {
namespace {

// Times T + s in which the bias takes over an error.
constexpr double kSlowness = 10;
// Further from the target than this share of it the bias does not wind up; but it gives back what
// is against the error, which it could hold for ever.
constexpr double kNear = 0.2;

}  // namespace

double CellServo::rate(int axis, double pressure, double target) {
  const double error = pressure - target;
  const double time = interval + slowness, answer = error / (modulus * time);
  double& b = bias[axis];
  if (std::fabs(error) < kNear * target || answer * b < 0) {
    b = std::clamp(b + answer * interval / (kSlowness * time), -most, most);
  }
  return std::clamp(b + answer, -most, most);
}

}  // namespace grainfield::dem
