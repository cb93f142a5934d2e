// Figures of gases of hard grains.
#pragma once
#include <vector>

#include "coupling/output/figure.h"
#include "coupling/studies/hard_disks/page.h"

namespace grainfield::coupling {

/// All fractions and realizations of a run.
struct GasFacts {
  const GasResults& results;
  const FigureSamples& figures;  ///< "gas.FRACTION.*", as the simulations left them
};
const std::vector<RunFigure<GasFacts>>& gas_rows();

}  // namespace grainfield::coupling
