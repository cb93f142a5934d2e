// Elastic moduli of one packing from small strains of it, forth and back
// (dem/run/probe_record.h).
#pragma once
#include "coupling/elastic_constants/space_symmetry.h"
#include "dem/run/probe_record.h"

namespace grainfield::coupling {

struct ProbedPacking {
  /// Central, one for each direction: what both ways share (a rest that is not quite one) drops
  /// out.
  SpaceIncrements increments;
  SpaceModuli moduli;
  double gained = 0, lost = 0, sliding = 0;  ///< largest share of the contacts in any probe
  /// Root of sum |forth + back|^2 over sum |forth - back|^2 of the stress changes: their part that
  /// is even in the strain over the odd one, 0 for a linear law.
  double nonlinear = 0;
  /// Largest |C_ab - C_ba| of the axes over the mean of C_aa, where each axis is strained alone: 0
  /// where the stress has a potential.
  double asymmetry = 0;
};

/// Throws as space_moduli().
ProbedPacking probed_packing(const dem::StateProbes& probes);

}  // namespace grainfield::coupling
