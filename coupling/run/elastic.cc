#include "coupling/run/elastic.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "coupling/run/models_only.h"

namespace grainfield::coupling {
namespace {

std::vector<ModelChoice> of_dimension(const Case& value) {
  std::vector<ModelChoice> out;
  for (const auto& choice : value.models) {
    const auto& info = continuum::find_model(choice.name);
    // A model that takes a dimension gets the study's.
    if (info.dim == 0 || info.dim == static_cast<int>(value.elastic.dim)) out.push_back(choice);
  }
  if (out.size() < 2) {
    throw std::invalid_argument(fmt::format(
        "compare.models: found {} model(s) of dimension elastic.dim = {}, expected two or more",
        out.size(), value.elastic.dim));
  }
  return out;
}

}  // namespace

StudyResult analyse_elastic(const Case& value) {
  const ElasticSetup& setup = value.elastic;
  const auto [least, most] = std::minmax_element(setup.depths.begin(), setup.depths.end());
  const bool layer = value.study == "elastic-layer";
  ModelsOnly where;
  where.facts.force = where.load = setup.force;
  where.facts.height = layer ? setup.height : *most;
  where.facts.dim = static_cast<int>(setup.dim);
  where.facts.depth = *least;
  where.facts.base = layer ? setup.base : "";
  where.depths = setup.depths;
  where.half_width = setup.half_width;
  where.points = static_cast<int>(setup.points);
  return compare_models(value, of_dimension(value), where);
}

namespace {

Study elastic_study(const char* name, const char* meaning) {
  Study out;
  out.name = name;
  out.meaning = meaning;
  out.sections = {"elastic"};
  out.fills = {"F", "h", "dim", "depth"};
  out.analyse = [](const Case& value, const std::vector<std::string>&, int) {
    return analyse_elastic(value);
  };
  return out;
}

}  // namespace

Study elastic_layer_study() {
  Study out = elastic_study("elastic-layer", "finite elements of a loaded layer, closed form");
  out.fills.emplace_back("base");
  return out;
}

Study elastic_half_space_study() {
  return elastic_study("elastic-half-space", "finite elements of a half space, closed form");
}

}  // namespace grainfield::coupling
