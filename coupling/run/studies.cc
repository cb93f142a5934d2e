#include "coupling/run/studies.h"

#include <stdexcept>

#include "coupling/fields/study.h"
#include "coupling/fit/layer_study.h"
#include "coupling/fit/study.h"
#include "coupling/run/elastic.h"
#include "coupling/run/lattice_pile.h"
#include "coupling/run/osl.h"
#include "coupling/run/pair.h"
#include "coupling/run/pile.h"
#include "coupling/run/point_load.h"
#include "coupling/run/sample.h"
#include "coupling/run/wedge.h"

namespace grainfield::coupling {

const std::vector<Study>& studies() {
  static const std::vector<Study> all{
      point_load_study(),        point_load_verdict_study(), pile_study(),      pile_fields_study(),
      pile_fit_study(),          lattice_pile_study(),       sample_study(),    pair_study(),
      elastic_layer_study(),     elastic_half_space_study(), osl_wedge_study(), osl_layer_study(),
      orthotropic_layer_study(), wedge_core_study(),         wedge_study(),
  };
  return all;
}

const Study* find_study(const std::string& name) {
  for (const Study& study : studies()) {
    if (study.name == name) return &study;
  }
  return nullptr;
}

const Study& study_of(const Case& value) {
  const Study* study = find_study(value.study);
  if (study == nullptr) throw std::logic_error("unknown study " + value.study);
  return *study;
}

}  // namespace grainfield::coupling
