#include <cmath>
#include <limits>
#include <stdexcept>

#include "coupling/run/wedge.h"

namespace grainfield::coupling {
namespace {

// Half the width of "the axis", over half the width of the base, and what counts as equal.
constexpr double kAxis = 0.05, kEqual = 0.98;

}  // namespace

BaseShape base_shape(const Eigen::VectorXd& x, const Eigen::VectorXd& pressure, double half_width) {
  BaseShape out;
  out.largest = -std::numeric_limits<double>::infinity();
  double axis = 0, quarter = 0;
  int near = 0, at_quarter = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double p = pressure[i], at = std::abs(x[i]);
    if (!std::isfinite(p)) continue;
    if (at <= kAxis * half_width) axis += p, ++near;
    // Slack: symmetric points count on both sides or on none.
    if (std::abs(at - half_width / 4) <= kAxis * half_width * (1 + 1e-9))
      quarter += p, ++at_quarter;
    if (p > out.largest * (1 + 1e-9)) out.largest = p, out.largest_at = at;
  }
  if (near == 0 || at_quarter == 0)
    throw std::invalid_argument(
        "base_shape: no pressure near the axis or at a quarter of the base");
  out.axis = axis / near;
  out.quarter = quarter / at_quarter;
  out.dip_ratio = out.axis / out.largest;
  const bool aside = out.largest_at > kAxis * half_width;
  out.word = aside && out.dip_ratio < kEqual    ? "dip"
             : out.quarter >= kEqual * out.axis ? "plateau"
                                                : "peak";
  return out;
}

}  // namespace grainfield::coupling
