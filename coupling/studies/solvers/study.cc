// Models against each other without grains, finite elements and closed forms: elasticity of a layer
// or half space, of a heap's core, oriented stress linearity of a heap or layer. The first model
// takes the place of the simulation in the tables; the others are compared with it.
#include "coupling/case/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "coupling/models/subject.h"
#include "coupling/run/study_result.h"
#include "coupling/studies/solvers/keys.h"
#include "coupling/studies/solvers/models_only.h"
#include "coupling/studies/solvers/setup.h"

namespace grainfield::coupling {
namespace {

bool is_osl(const Case& value) { return value.study.starts_with("osl-"); }
bool is_heap(const Case& value) {
  return value.study == "wedge-core" || value.study == "osl-wedge";
}

// The models of the study's dimension; one that takes a dimension gets the study's.
std::vector<ModelChoice> choices_of(const Case& value) {
  if (is_osl(value)) {
    if (value.models.size() >= 2) return value.models;
    throw std::invalid_argument(fmt::format(
        "compare.models: found {} model(s), expected two or more", value.models.size()));
  }
  const auto dim = value.get<ProblemSetup>().dim;
  std::vector<ModelChoice> out;
  for (const auto& choice : value.models) {
    const int own = continuum::find_model(choice.name).dim;
    if (own == 0 || own == static_cast<int>(dim)) out.push_back(choice);
  }
  if (out.size() < 2) {
    throw std::invalid_argument(fmt::format(
        "compare.models: found {} model(s) of dimension problem.dim = {}, expected two or more",
        out.size(), dim));
  }
  return out;
}

// Where the models are looked at, and what they are told.
ModelsOnly places_of(const Case& value) {
  const ProblemSetup& setup = value.get<ProblemSetup>();
  const auto [least, most] = std::minmax_element(setup.depths.begin(), setup.depths.end());
  const bool heap = is_heap(value), half_space = value.study == "elastic-half-space";
  ModelsOnly where;
  RunFacts& facts = where.facts;
  facts.force = setup.force;
  facts.height = half_space ? *most : setup.height;
  facts.dim = is_osl(value) ? 2 : static_cast<int>(setup.dim);
  facts.depth = *least;
  if (!is_osl(value) && !heap && !half_space) facts.base = setup.base;
  if (value.study == "orthotropic-layer") facts.numbers = {{"r", setup.r}, {"t", setup.t}};
  // Pressures of a heap are counted in h times a weight of 1 N/m2.
  where.load = heap ? setup.height * setup.height : setup.force;
  where.depths = setup.depths;
  where.half_width = setup.half_width;
  where.points = static_cast<int>(setup.points);
  return where;
}

Study solver_study(const char* name, const char* meaning, std::vector<std::string> without,
                   std::vector<std::string> fills) {
  Study out;
  out.name = name;
  out.meaning = meaning;
  out.sections = {kProblemKeys};
  out.without = std::move(without);
  out.fills = std::move(fills);
  out.check = [](const Case& value) {
    if (value.study != "elastic-half-space") require_depths(value.get<ProblemSetup>());
    const int dim = places_of(value).facts.dim;
    if (value.compare.models != CompareSetup{}.models)
      require_subject(value.models, is_heap(value) ? Subject::heap : Subject::load, dim,
                      "compare.models");
    require_models(choices_of(value), places_of(value).facts);
  };
  out.analyse = [](const Case& value, const std::vector<std::string>&, int) {
    return compare_models(value, choices_of(value), places_of(value));
  };
  return out;
}

}  // namespace

Study elastic_layer_study() {
  return solver_study("elastic-layer", "finite elements of a loaded layer, closed form",
                      {"problem.r", "problem.t"}, {"F", "h", "dim", "depth", "base"});
}

Study elastic_half_space_study() {
  return solver_study("elastic-half-space", "finite elements of a half space, closed form",
                      {"problem.r", "problem.t"}, {"F", "h", "dim", "depth"});
}

Study orthotropic_layer_study() {
  return solver_study("orthotropic-layer",
                      "finite elements of a loaded layer with two elastic axes, half plane",
                      {"problem.dim"}, {"F", "h", "base", "r", "t"});
}

Study wedge_core_study() {
  return solver_study("wedge-core", "finite elements of a heap's elastic core, Cantelaube's form",
                      {"problem.r", "problem.t", "problem.force", "problem.dim", "problem.base"},
                      {"h"});
}

Study osl_wedge_study() {
  return solver_study("osl-wedge", "oriented stress linearity of a heap, solvers, closed form",
                      {"problem.dim", "problem.base", "problem.r", "problem.t", "problem.force"},
                      {"h"});
}

Study osl_layer_study() {
  return solver_study("osl-layer",
                      "oriented stress linearity of a loaded layer, solvers, closed form",
                      {"problem.dim", "problem.base", "problem.r", "problem.t"}, {"h", "F"});
}

}  // namespace grainfield::coupling
