#include "coupling/heap/cone_windows.h"

#include <array>
#include <numbers>
#include <vector>

#include "continuum/constants.h"
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

}  // namespace grainfield::coupling
