#include "coupling/studies/pile_fields/topic.h"
#include "coupling/studies/pile_fields/topic_result.h"

namespace grainfield::coupling {

const std::vector<Topic>& topics() {
  static const std::vector<Topic> all{
      {"rve_size", "stress, strain and fabric against the size of the RVE", rve_size_of_piles},
      {"strain_measures", "five measures of strain on the same points", strain_measures_of_piles},
      {"elastic", "K, G, E and nu over the heap", elastic_constants_of_piles},
      {"fabric", "fabric, coordination, orientation of grains", fabric_of_piles},
      {"forces", "base forces, contact angles, force chains, nearness to yield", forces_of_piles},
  };
  return all;
}

}  // namespace grainfield::coupling
