// What a packing is made of, all that `grainfield structure` tells of it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "coupling/averaging/grain_facts.h"
#include "coupling/statistics/exponential_tail.h"
#include "coupling/structure/base_forces.h"
#include "coupling/structure/coordination_counts.h"
#include "coupling/structure/force_chains.h"
#include "coupling/structure/grain_axes.h"
#include "coupling/structure/size_factor.h"

namespace grainfield::coupling {

/// Structure about one grain, from its contacts; angles in degrees from x, nan: there is none.
struct GrainStructure {
  int contacts = 0;
  bool rattler = false;
  double stress_trace = 0, stress_deviator = 0;  ///< N/m (in space Pa), tension positive
  double compression_angle = 0;  ///< of the axis of the greatest compression; in space nan
  double fabric_angle = 0;       ///< of the fabric's major axis; in space nan
  double long_angle = 0;         ///< along the grain's length; nan of disks and in space
  int chain = -1;                ///< index of its force chain, or -1
};

struct PackingStructure {
  CoordinationCounts counts;
  SizeFactor size;
  ForceChains chains;
  std::vector<GrainStructure> grains;  ///< in the snapshot's order
  std::optional<GrainAxes> axes;       ///< in the plane
  std::optional<BaseForces> base;      ///< where free grains touch one
  std::string no_base;                 ///< why there is none
  ExponentialTail tail;                ///< of base->normalised above 1
};

/// Throws std::invalid_argument without a free grain.
PackingStructure packing_structure(const dem::Snapshot& snapshot);

}  // namespace grainfield::coupling
