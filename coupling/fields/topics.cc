#include "coupling/fields/topic.h"
#include "coupling/fields/topic_result.h"

namespace grainfield::coupling {

const std::vector<Topic>& topics() {
  static const std::vector<Topic> all{
      {"rve_size", "stress, strain and fabric against the size of the RVE", look_at_rve_size},
      {"strain_measures", "five measures of strain on the same points", look_at_strain_measures},
      {"elastic", "K, G, E and nu over the heap", look_at_elastic},
      {"fabric", "fabric, coordination, orientation of grains", look_at_fabric},
      {"forces", "base forces, contact angles, force chains, nearness to yield", look_at_forces},
  };
  return all;
}

}  // namespace grainfield::coupling
