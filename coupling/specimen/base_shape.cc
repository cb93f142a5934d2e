#include "coupling/specimen/base_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace grainfield::coupling {
namespace {

// Half the width of "the axis", over half the width of the base, and what counts as equal.
constexpr double kAxis = 0.05, kEqual = 0.98;

}  // namespace

BaseShape base_shape(const Eigen::VectorXd& x, const Eigen::VectorXd& pressure, double half_width) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  // Left and right of the axis.
  struct Side {
    double largest = kNone, at = 0, quarter = 0;
    int at_quarter = 0;
  } sides[2];
  double axis = 0;
  int near = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double p = pressure[i], at = std::abs(x[i]);
    if (!std::isfinite(p)) continue;
    if (at <= kAxis * half_width) axis += p, ++near;
    for (const int s : {0, 1}) {
      if (s == 0 ? x[i] > 0 : x[i] < 0) continue;  // the axis is part of both
      Side& side = sides[s];
      // Slack: symmetric points count on both sides or on none.
      if (std::abs(at - half_width / 4) <= kAxis * half_width * (1 + 1e-9))
        side.quarter += p, ++side.at_quarter;
      if (p > side.largest * (1 + 1e-9)) side.largest = p, side.at = at;
    }
  }
  if (near == 0 || sides[0].at_quarter == 0 || sides[1].at_quarter == 0)
    throw std::invalid_argument(
        "base_shape: no pressure near the axis or at a quarter of the base");
  BaseShape out;
  const Side& higher = sides[sides[1].largest > sides[0].largest * (1 + 1e-9) ? 1 : 0];
  const Side& lower = sides[&higher == &sides[0] ? 1 : 0];
  for (Side& side : sides) side.quarter /= side.at_quarter;
  out.axis = axis / near;
  out.largest = higher.largest;
  out.largest_at = higher.at;
  out.quarter = std::min(sides[0].quarter, sides[1].quarter);
  out.dip_ratio = out.axis / out.largest;
  // A heap whose largest pressure lies beside the axis on one side only has a peak there.
  const bool aside = std::min(sides[0].at, sides[1].at) > kAxis * half_width;
  out.word = aside && out.axis < kEqual * lower.largest ? "dip"
             : out.quarter >= kEqual * out.axis         ? "plateau"
                                                        : "peak";
  return out;
}

}  // namespace grainfield::coupling
