// The moduli of a layer at rest by depth, from one set of small strains.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "coupling/elastic_constants/slab_moduli.h"
#include "dem/laws/materials.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

struct SlabProbing {
  double strain = 1e-6;
  int slabs = 4;
  int strips = 4;  ///< of each slab; their scatter is its error
};

struct ProbedSlabs {
  std::vector<SlabModuli> slabs;  ///< from the surface downwards
  SlabModuli whole;               ///< all of them as one
  double nonlinear = 0;           ///< of the whole: part of the stress changes even in the strain
  double contacts_changed = 0;    ///< largest share of contacts new, gone or newly sliding
};

/// `layer`: as LayerProber's. None when go_on said no. Throws as LayerProber, and ComputationFailed
/// where the strains do not tell the constants.
std::optional<ProbedSlabs> probe_slabs(const dem::Snapshot& layer, const dem::Materials& materials,
                                       double height, const SlabProbing& how,
                                       const std::function<bool(double)>& go_on = nullptr);

/// Each slab over the realizations, which have the same number of them; depths are means.
std::vector<SlabModuli> over_realizations(const std::vector<std::vector<SlabModuli>>& all);

}  // namespace grainfield::coupling
