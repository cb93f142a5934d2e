#include "coupling/specimen/axis_stress.h"

#include <algorithm>
#include <utility>

#include "continuum/constants.h"
#include "coupling/averaging/branches.h"

namespace grainfield::coupling {
namespace {

// Share of the segment from a to b inside the box: between the last entry and the first exit
// (Liang and Barsky 1984).
double share_inside(const dem::Vec3& a, const dem::Vec3& b, const Eigen::Vector2d& low,
                    const Eigen::Vector2d& high) {
  double enter = 0, leave = 1;
  for (const int k : {0, 1}) {
    const double way = b[k] - a[k];
    if (way == 0) {
      if (a[k] < low[k] || a[k] > high[k]) return 0;
      continue;
    }
    double first = (low[k] - a[k]) / way, last = (high[k] - a[k]) / way;
    if (first > last) std::swap(first, last);
    enter = std::max(enter, first);
    leave = std::min(leave, last);
  }
  return std::max(0.0, leave - enter);
}

}  // namespace

double axis_stress_ratio(const dem::Snapshot& pile, const PileFrame& frame,
                         const HeapSetup& setup) {
  const Eigen::Vector2d low(frame.apex_x - setup.centre * frame.half_left,
                            frame.floor + setup.axis_from * frame.height),
      high(frame.apex_x + setup.centre * frame.half_right,
           frame.floor + setup.axis_to * frame.height);
  double across = 0, down = 0;
  for_each_branch(
      pile, {.extend = false},
      [&](const dem::Vec3& a, const dem::Vec3& b, const dem::Vec3& force) {
        const double share = share_inside(a, b, low, high);
        across += share * force.x() * (b - a).x();
        down += share * force.y() * (b - a).y();
      },
      [](const dem::Vec3& /*point*/, const dem::Vec3& /*force*/) {});
  return down == 0 ? kNan : across / down;
}

}  // namespace grainfield::coupling
