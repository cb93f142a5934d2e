// Figures of piles; those of the base and of the dip are of cones, too.
#pragma once
#include <vector>

#include "coupling/case/case.h"
#include "coupling/result/figure.h"
#include "coupling/specimen/dip.h"
#include "coupling/specimen/pile_frame.h"
#include "coupling/specimen/setup.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// One pile of an ensemble.
struct PileFacts {
  const dem::Snapshot& pile;
  const PileFrame& frame;
  const HeapSetup& heap;
  double left_deg = 0, right_deg = 0;  ///< the flanks' slopes, as its run left them
};
const std::vector<Figure<PileFacts>>& pile_rows();

/// The mean pressure in windows of its base.
const std::vector<Figure<BaseWindows>>& window_rows();

/// The same pile under another gravity; "change.NAME." comes before the keys.
struct ChangeFacts {
  double coordination = 0, coordination_before = 0;
  double difference = 0, difference_before = 0;  ///< shoulder - centre, own rho g h
};
const std::vector<Figure<ChangeFacts>>& change_rows();

/// How the piles of a case are poured.
const std::vector<RunFigure<Case>>& source_rows();

/// A whole run of piles.
struct PilesFacts {
  const Case& value;
  const FigureSamples& figures;  ///< of all piles
};
const std::vector<RunFigure<PilesFacts>>& piles_rows();

/// The pressure on the base, ensemble mean, smeared.
struct BaseFacts {
  double centre = 0, largest = 0;  ///< rho g h
  double largest_at = 0;           ///< h, from the apex
  double width = 0;                ///< of the kernel, m
};
const std::vector<RunFigure<BaseFacts>>& base_rows();
const std::vector<RunFigure<Dip>>& dip_rows();

}  // namespace grainfield::coupling
