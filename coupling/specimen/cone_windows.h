// The dip of the base pressure under a cone's apex.
#pragma once
#include "coupling/averaging/base_space.h"
#include "coupling/averaging/cone.h"
#include "coupling/specimen/dip.h"
#include "coupling/specimen/setup.h"

namespace grainfield::coupling {

/// Fewer contacts than this in the disk say nothing of its pressure.
inline constexpr int kLeastInDisk = 5;

struct ConeWindows {
  BaseWindows mean;         ///< by radius over the foot's, over the angle
  int in_disk = 0;          ///< contacts in the disk; below kLeastInDisk its pressure is nan
  double sector_error = 0;  ///< standard error of shoulder - centre over the sectors, rho g h
};
/// Mean vertical pressure of one cone in a disk and a ring of its base, from the forces on the base
/// themselves (no smearing), in units of its rho g h.
ConeWindows cone_windows(const dem::Snapshot& cone, const ConeFrame& frame, const HeapSetup& setup);

/// Standard errors of the means over rings (ring_means) from so many equal sectors, at least 2:
/// what one cone tells of its own mean, as if sectors were independent. nan where a ring has fewer
/// places than sectors.
Eigen::VectorXd ring_sector_errors(const RingPlaces& rings, const Eigen::VectorXd& values,
                                   int sectors);

}  // namespace grainfield::coupling
