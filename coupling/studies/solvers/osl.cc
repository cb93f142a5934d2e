// Oriented stress linearity as a field problem against its closed forms, without grains: on
// horizontal lines through the heap (osl-wedge) or the layer (osl-layer).
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "coupling/case/study.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/solvers/keys.h"
#include "coupling/studies/solvers/models_only.h"
#include "coupling/studies/solvers/setup.h"

namespace grainfield::coupling {
namespace {

// Where the models are looked at, and what they are told.
ModelsOnly places_of(const Case& value) {
  const ElasticSetup& setup = value.get<ElasticSetup>();
  if (value.models.size() < 2) {
    throw std::invalid_argument(fmt::format(
        "compare.models: found {} model(s), expected two or more", value.models.size()));
  }
  const bool heap = value.study == "osl-wedge";
  ModelsOnly where;
  RunFacts& facts = where.facts;
  facts.height = setup.height;
  facts.dim = 2;
  facts.force = setup.force;
  facts.depth = *std::min_element(setup.depths.begin(), setup.depths.end());
  // Pressures of a heap are counted in h times a weight of 1 N/m2.
  where.load = heap ? setup.height * setup.height : setup.force;
  where.depths = setup.depths;
  where.half_width = setup.half_width;
  where.points = static_cast<int>(setup.points);
  return where;
}

Study osl_study(const char* name, const char* meaning) {
  Study out;
  out.name = name;
  out.meaning = meaning;
  out.sections = {kElasticKeys};
  out.without = {"elastic.dim", "elastic.base", "elastic.r", "elastic.t"};
  out.fills = {"h"};
  out.check = [](const Case& value) {
    require_depths(value.get<ElasticSetup>());
    require_models(value.models, places_of(value).facts);
  };
  out.analyse = [](const Case& value, const std::vector<std::string>&, int) {
    return compare_models(value, value.models, places_of(value));
  };
  return out;
}

}  // namespace

Study osl_wedge_study() {
  Study out = osl_study("osl-wedge", "oriented stress linearity of a heap, solvers, closed form");
  out.without.emplace_back("elastic.force");
  return out;
}

Study osl_layer_study() {
  Study out =
      osl_study("osl-layer", "oriented stress linearity of a loaded layer, solvers, closed form");
  out.fills.emplace_back("F");
  return out;
}

}  // namespace grainfield::coupling
