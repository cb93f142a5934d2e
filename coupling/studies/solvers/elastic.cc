// A finite-element model against its closed form, without grains. The first model takes the place
// of the simulation in the tables; the others are compared with it.
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

std::vector<ModelChoice> of_dimension(const Case& value) {
  std::vector<ModelChoice> out;
  for (const auto& choice : value.models) {
    const auto& info = continuum::find_model(choice.name);
    // A model that takes a dimension gets the study's.
    if (info.dim == 0 || info.dim == static_cast<int>(value.get<ElasticSetup>().dim))
      out.push_back(choice);
  }
  if (out.size() < 2) {
    throw std::invalid_argument(fmt::format(
        "compare.models: found {} model(s) of dimension elastic.dim = {}, expected two or more",
        out.size(), value.get<ElasticSetup>().dim));
  }
  return out;
}

// Where the models are looked at, and what they are told.
ModelsOnly places_of(const Case& value) {
  const ElasticSetup& setup = value.get<ElasticSetup>();
  const auto [least, most] = std::minmax_element(setup.depths.begin(), setup.depths.end());
  const bool heap = value.study == "wedge-core", layer = value.study != "elastic-half-space";
  ModelsOnly where;
  where.facts.force = setup.force;
  // Pressures of a heap are counted in h times a weight of 1 N/m2.
  where.load = heap ? setup.height * setup.height : setup.force;
  where.facts.height = layer ? setup.height : *most;
  where.facts.dim = static_cast<int>(setup.dim);
  where.facts.depth = *least;
  where.facts.base = layer && !heap ? setup.base : "";
  if (value.study == "orthotropic-layer") where.facts.numbers = {{"r", setup.r}, {"t", setup.t}};
  where.depths = setup.depths;
  where.half_width = setup.half_width;
  where.points = static_cast<int>(setup.points);
  return where;
}

Study elastic_study(const char* name, const char* meaning) {
  Study out;
  out.name = name;
  out.meaning = meaning;
  out.sections = {kElasticKeys};
  out.without = {"elastic.r", "elastic.t"};
  out.fills = {"F", "h", "dim", "depth"};
  out.check = [](const Case& value) {
    if (value.study != "elastic-half-space") require_depths(value.get<ElasticSetup>());
    require_models(of_dimension(value), places_of(value).facts);
  };
  out.analyse = [](const Case& value, const std::vector<std::string>&, int) {
    return compare_models(value, of_dimension(value), places_of(value));
  };
  return out;
}

}  // namespace

Study elastic_layer_study() {
  Study out = elastic_study("elastic-layer", "finite elements of a loaded layer, closed form");
  out.fills.emplace_back("base");
  return out;
}

Study orthotropic_layer_study() {
  Study out = elastic_study("orthotropic-layer",
                            "finite elements of a loaded layer with two elastic axes, half plane");
  out.without = {"elastic.dim"};
  out.fills = {"F", "h", "base", "r", "t"};
  return out;
}

Study wedge_core_study() {
  Study out =
      elastic_study("wedge-core", "finite elements of a heap's elastic core, Cantelaube's form");
  for (const char* key : {"elastic.force", "elastic.dim", "elastic.base"})
    out.without.emplace_back(key);
  out.fills = {"h"};
  return out;
}

Study elastic_half_space_study() {
  return elastic_study("elastic-half-space", "finite elements of a half space, closed form");
}

}  // namespace grainfield::coupling
