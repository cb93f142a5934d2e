// Figures of loaded layers.
#pragma once
#include <vector>

#include "coupling/compare/ring.h"
#include "coupling/result/figure.h"

namespace grainfield::coupling {

/// A run of layers in the plane or in space.
struct LayersFacts {
  double depth = 0, force = 0, diameter = 0;  ///< means, m and N
  int dim = 2;
};
const std::vector<RunFigure<LayersFacts>>& layers_rows();

/// The response on the base in space, by radius about the load.
struct RingFacts {
  RingAgainstAxis ring;
  double depth = 0;                            ///< m
  double within_radius = 0, within_force = 0;  ///< where profiles end, m; the response there over F
};
const std::vector<ErrorFigure<RingFacts>>& ring_rows();

}  // namespace grainfield::coupling
