// Figures of cones, besides those that they share with piles (studies/pile/figures.h).
#pragma once
#include <string>
#include <vector>

#include "coupling/averaging/cone.h"
#include "coupling/result/figure.h"
#include "coupling/specimen/cone_windows.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// One cone of an ensemble.
struct ConeFacts {
  const dem::Snapshot& cone;
  const ConeFrame& frame;
  const ConeWindows& windows;
  double weight = 0;                  ///< of its grains, N
  double on_rings = 0, on_floor = 0;  ///< force on the base by its rings, and as it is, N
  double sector_deviation_deg = 0;    ///< of the slopes of its sectors
};
const std::vector<Figure<ConeFacts>>& cone_rows();

/// A whole run of cones.
struct ConesFacts {
  std::string source;                              ///< empty: unknown
  double largest_shear = 0, largest_shear_at = 0;  ///< rho g h; h from the axis
};
const std::vector<RunFigure<ConesFacts>>& cones_rows();

}  // namespace grainfield::coupling
