#include "coupling/specimen/cone_windows.h"

#include <array>
#include <limits>
#include <numbers>
#include <vector>

#include "continuum/constants.h"
#include "coupling/averaging/base.h"
#include "coupling/averaging/base_space.h"

namespace grainfield::coupling {

ConeWindows cone_windows(const dem::Snapshot& cone, const ConeFrame& frame,
                         const HeapSetup& setup) {
  ConeWindows out;
  std::array<double, kConeSectors> centre{}, shoulder{};
  for (const BaseSupport& f : base_supports(cone)) {
    const double x = f.point.x() - frame.apex_x, y = f.point.y() - frame.apex_y;
    const auto sector = static_cast<std::size_t>(cone_sector(x, y));
    const double at = std::hypot(x, y) / frame.foot;
    if (at < setup.centre) {
      centre[sector] += f.force.z();
      ++out.in_disk;
    }
    if (at >= setup.shoulder_from && at < setup.shoulder_to) shoulder[sector] += f.force.z();
  }
  const double disk = std::numbers::pi * frame.foot * frame.foot;
  const double inner = disk * setup.centre * setup.centre;
  const double ring =
      disk * (setup.shoulder_to * setup.shoulder_to - setup.shoulder_from * setup.shoulder_from);
  std::vector<double> differences;
  for (std::size_t k = 0; k < kConeSectors; ++k) {
    const double c = centre[k] / inner / frame.pressure();
    const double s = shoulder[k] / ring / frame.pressure();
    out.mean.centre += c;
    out.mean.shoulder += s;
    differences.push_back(kConeSectors * (s - c));
  }
  if (out.in_disk < kLeastInDisk) out.mean.centre = kNan;
  out.sector_error = spread_of(differences).standard_error;
  return out;
}

Eigen::VectorXd ring_sector_errors(const RingPlaces& rings, const Eigen::VectorXd& values,
                                   int sectors) {
  using Eigen::Index;
  Eigen::VectorXd out(static_cast<Index>(rings.count.size()));
  Index at = 0;
  for (Index k = 0; k < out.size(); ++k) {
    const Index count = rings.count[static_cast<std::size_t>(k)];
    std::vector<double> sum(static_cast<std::size_t>(sectors)), places(sum.size());
    for (Index p = 0; p < count; ++p) {
      const auto sector = static_cast<std::size_t>(p * sectors / count);
      sum[sector] += values[at + p];
      ++places[sector];
    }
    for (std::size_t sector = 0; sector < sum.size(); ++sector) sum[sector] /= places[sector];
    out[k] =
        count < sectors ? std::numeric_limits<double>::quiet_NaN() : spread_of(sum).standard_error;
    at += count;
  }
  return out;
}

}  // namespace grainfield::coupling
