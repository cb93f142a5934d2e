// Checks that involve more than one key.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "continuum/idle.h"
#include "continuum/settings.h"
#include "coupling/case/apply.h"
#include "coupling/run/studies.h"

namespace grainfield::coupling {
namespace {

// Where a key was written; a key that was not is blamed on the file as a whole.
Assignment written(const Draft& draft, const std::string& path) {
  const auto at = draft.last.find(path);
  if (at != draft.last.end()) return at->second;
  Assignment none;
  none.path = path;
  none.origin = draft.file;
  return none;
}

void check_sections(const Draft& draft) {
  for (const auto& [path, a] : draft.last) {
    const Key* key = find_key(path);
    if (!key_applies(*key, draft.value.study)) {
      reject(a, path, fmt::format("has no meaning for study = \"{}\"", draft.value.study));
    }
  }
}

// A setting that says what holds anyway; labels and comparisons of cases do without it.
bool is_default(const continuum::ModelInfo& info, const std::string& name,
                const std::string& value) {
  for (const auto& p : info.parameters) {
    if (p.name != name) continue;
    if (!p.choices.empty()) return value == p.choices.front();
    if (continuum::is_text(p)) return value.empty();
    return continuum::number_of({{name, value}}, name) == p.value;
  }
  return false;
}

// Every [model.LABEL] table, whether it is used or not.
std::map<std::string, ModelChoice> read_models(const Draft& draft) {
  std::map<std::string, ModelChoice> out;
  for (const auto& [label, table] : draft.models) {
    ModelChoice choice{label, label, {}};
    Assignment where = written(draft, "compare.models");
    if (!table.empty()) where = table.begin()->second;
    if (const auto name = table.find("name"); name != table.end()) {
      where = name->second;
      choice.name = scalar_text(name->second.items.front());
    }
    const continuum::ModelInfo* info = nullptr;
    try {
      info = &continuum::find_model(choice.name);
    } catch (const continuum::BadParameter& e) {
      reject(where, "model." + label, e.what());
    }
    for (const auto& [parameter, a] : table) {
      if (parameter == "name") continue;
      const std::string value = scalar_text(a.items.front());
      try {
        continuum::complete(*info, {{parameter, value}});
      } catch (const continuum::BadParameter& e) {
        reject(a, a.path, e.what());
      }
      if (!is_default(*info, parameter, value) || filled_by_run(parameter, draft.value.study)) {
        choice.settings[parameter] = value;
      }
    }
    // A study that varies the model's settings looks at every combination itself.
    if (draft.value.study != "wedge") {
      if (const auto idle = continuum::find_idle(*info, choice.settings)) {
        const Assignment& a = table.at(idle->parameter);
        reject(a, a.path, idle->refusal);
      }
    }
    out.emplace(label, choice);
  }
  return out;
}

void choose_models(Draft& draft) {
  auto tables = read_models(draft);
  const Assignment where = written(draft, "compare.models");
  Case& value = draft.value;
  value.models.clear();
  std::set<std::string> seen;
  for (const auto& label : model_names(value)) {
    if (!seen.insert(label).second) reject(where, "compare.models", "\"" + label + "\" twice");
    const auto table = tables.find(label);
    ModelChoice choice = table != tables.end() ? table->second : ModelChoice{label, label, {}};
    try {
      const auto& info = continuum::find_model(choice.name);
      if (study_of(value).has_grains() && continuum::dimension(info, choice.settings) != 2) {
        reject(where, "compare.models",
               fmt::format("\"{}\" is three-dimensional, the grains are not", label));
      }
    } catch (const continuum::BadParameter& e) {
      reject(where, "compare.models", e.what());
    }
    value.models.push_back(std::move(choice));
  }
  if (value.models.empty() && !study_of(value).models_optional)
    reject(where, "compare.models", "found no model, expected one or more");
}

void check_elastic(const Draft& draft) {
  const Case& value = draft.value;
  if (!section_applies("elastic", value.study) || value.study == "elastic-half-space") return;
  const auto& depths = value.elastic.depths;
  const double deepest = *std::max_element(depths.begin(), depths.end());
  if (deepest > value.elastic.height) {
    reject(written(draft, "elastic.depths"), "elastic.depths",
           fmt::format("found {:g}, allowed: up to elastic.height = {:g}", deepest,
                       value.elastic.height));
  }
}

void check_sizes(const Draft& draft) {
  const auto& p = draft.value.layer.packing;
  if (p.radius_min > p.radius_max) {
    reject(written(draft, "packing.radius_min"), "packing.radius_min",
           fmt::format("found {:g}, allowed: up to packing.radius_max = {:g}", p.radius_min,
                       p.radius_max));
  }
  if (p.sizes == "bidisperse" && p.radius_small > p.radius) {
    reject(
        written(draft, "packing.radius_small"), "packing.radius_small",
        fmt::format("found {:g}, allowed: up to packing.radius = {:g}", p.radius_small, p.radius));
  }
}

void check_heap(const Draft& draft) {
  if (!section_applies("heap", draft.value.study)) return;
  const HeapSetup& h = draft.value.heap;
  if (h.shoulder_from >= h.shoulder_to) {
    reject(written(draft, "heap.shoulder_from"), "heap.shoulder_from",
           fmt::format("found {:g}, allowed: below heap.shoulder_to = {:g}", h.shoulder_from,
                       h.shoulder_to));
  }
  if (h.centre > h.shoulder_from) {
    reject(written(draft, "heap.centre"), "heap.centre",
           fmt::format("found {:g}, allowed: up to heap.shoulder_from = {:g}", h.centre,
                       h.shoulder_from));
  }
}

// A list of the fit needs at least one entry, and none twice: the same values would count twice.
template <class T>
void check_list(const Draft& draft, const std::string& key, std::vector<T> list) {
  if (list.empty()) reject(written(draft, key), key, "found an empty list, expected one or more");
  std::sort(list.begin(), list.end());
  const auto twice = std::adjacent_find(list.begin(), list.end());
  if (twice != list.end()) {
    reject(written(draft, key), key,
           fmt::format("found {} twice, allowed: every entry once", *twice));
  }
}

void check_verdict(const Draft& draft) {
  if (!section_applies("verdict", draft.value.study)) return;
  const VerdictSetup& v = draft.value.verdict;
  check_list(draft, "verdict.models", v.models);
  check_list(draft, "verdict.components", v.components);
  if (!v.finite_elements.empty()) check_list(draft, "verdict.finite_elements", v.finite_elements);
  for (const std::string& name : v.finite_elements) {
    try {
      continuum::find_model(name);
    } catch (const continuum::BadParameter& e) {
      reject(written(draft, "verdict.finite_elements"), "verdict.finite_elements", e.what());
    }
  }
}

// What only the discrete elements know, such as the stable time step.
void check_grains(const Draft& draft) {
  const Study& study = study_of(draft.value);
  if (!study.has_grains()) return;
  if (section_applies("packing", study.name)) check_sizes(draft);
  try {
    study.make_run(draft.value, 0, 1);
  } catch (const std::invalid_argument& e) {
    const std::string what = e.what();
    const std::string path = what.substr(0, what.find(':'));
    throw std::invalid_argument(written(draft, path).origin + ": " + what);
  }
}

void check_sweep(const Draft& draft) {
  const SweepSetup& sweep = draft.value.sweep;
  if (sweep.key.empty()) {
    if (!sweep.values.empty()) {
      reject(written(draft, "sweep.values"), "sweep.values", "needs sweep.key as well");
    }
    return;
  }
  const Assignment where = written(draft, "sweep.key");
  if (sweep.key.compare(0, 6, "sweep.") == 0)
    reject(where, "sweep.key", "cannot be one of [sweep]");
  if (sweep.values.empty()) reject(where, "sweep.key", "needs sweep.values as well");
  std::set<std::string> seen;
  for (const auto& text : sweep.values) {
    if (!seen.insert(text).second) {
      reject(written(draft, "sweep.values"), "sweep.values", "\"" + text + "\" twice");
    }
    Draft one = draft;
    one.value.sweep = {};
    one.last.erase("sweep.key");
    one.last.erase("sweep.values");
    try {
      apply(one, parse_override(sweep.key + "=" + text));
      finish(one);
    } catch (const std::invalid_argument& e) {
      std::string what = e.what();
      const std::string set = "--set: ";
      if (what.compare(0, set.size(), set) == 0) what = what.substr(set.size());
      reject(written(draft, find_key(sweep.key) != nullptr ? "sweep.values" : "sweep.key"),
             find_key(sweep.key) != nullptr ? "sweep.values" : "sweep.key", what);
    }
  }
}

}  // namespace

void check_fit(const Draft& draft) {
  if (!section_applies("fit", draft.value.study)) return;
  check_list(draft, "fit.models", draft.value.fit.models);
  check_list(draft, "fit.components", draft.value.fit.components);
  check_list(draft, "fit.heights", draft.value.fit.heights);
}

std::vector<std::string>& model_names(Case& value) {
  const Study* study = find_study(value.study);
  return study != nullptr && study->models_optional ? value.compare.of_heaps : value.compare.models;
}

void finish(Draft& draft) {
  draft.value.idle.clear();
  check_sections(draft);
  choose_models(draft);
  check_elastic(draft);
  check_heap(draft);
  check_fit(draft);
  check_verdict(draft);
  check_grains(draft);
  check_sweep(draft);
  for (const auto& [path, a] : draft.last) {
    const Key& key = *find_key(path);
    if (!is_idle(key, draft.value)) continue;
    draft.value.idle.push_back(fmt::format("{}: {}: has no effect, only with {} (now {})", a.origin,
                                           path, condition(key),
                                           value_text(*find_key(key.needs), draft.value)));
  }
}

}  // namespace grainfield::coupling
