// Checks that involve more than one key.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <map>
#include <stdexcept>
#include <type_traits>

#include "continuum/settings.h"
#include "continuum/without_effect.h"
#include "coupling/case/apply.h"
#include "coupling/case/cost.h"
#include "coupling/case/doubts.h"
#include "coupling/case/material.h"
#include "coupling/case/members.h"
#include "coupling/case/study.h"
#include "coupling/case/units.h"
#include "coupling/models/evaluate_model.h"
#include "coupling/models/fit_names.h"

namespace grainfield::coupling {
namespace {

// Tables [model.LABEL] of a case.
constexpr std::size_t kMostModels = 200;
// Grains that are drawn for one member of a sweep, however many there are.
constexpr std::int64_t kLeastDraws = 300;

void check_sections(const Draft& draft, MistakeList& mistakes) {
  for (const auto& [path, a] : draft.last) {
    const Key* key = find_key(path);
    if (key->space && !may_be_in_space(draft.value.study)) continue;  // check_dimensions
    if (key_applies(*key, draft.value.study)) continue;
    mistakes.attempt([&, &path = path, &a = a] {
      reject(a, path, fmt::format("has no meaning for study = \"{}\"", draft.value.study));
    });
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

// A label names fields, files and keys of summary.json.
void check_label(const Assignment& where, const std::string& label) {
  if (plain_name(label) && label.size() <= kLongestName) return;
  reject(where, "model." + label,
         fmt::format("found the label \"{}\", allowed: up to {} letters, digits, _ and -", label,
                     kLongestName));
}

// The model of a table [model.LABEL], whether it is used or not.
ModelChoice read_model(const Draft& draft, const std::string& label,
                       const std::map<std::string, Assignment>& table, MistakeList& mistakes) {
  ModelChoice choice{label, label, {}};
  Assignment where = written(draft, "compare.models");
  if (!table.empty()) where = table.begin()->second;
  check_label(where, label);
  if (const auto name = table.find("name"); name != table.end()) {
    where = name->second;
    choice.name = scalar_text(name->second.items.front());
  }
  const continuum::ModelInfo* info = nullptr;
  try {
    // With its parameters, of which a name that fits give may need one.
    for (const auto& [parameter, a] : table) {
      if (parameter != "name") choice.settings[parameter] = scalar_text(a.items.front());
    }
    choice = in_registry(choice);
    info = &continuum::find_model(choice.name);
  } catch (const continuum::BadParameter& e) {
    reject(where, "model." + label, e.what());
  }
  std::erase_if(choice.settings, [&](const auto& setting) {
    return table.count(setting.first) > 0 || is_default(*info, setting.first, setting.second);
  });
  for (const auto& [parameter, a] : table) {
    if (parameter == "name") continue;
    const std::string value = scalar_text(a.items.front());
    try {
      continuum::complete(*info, {{parameter, value}});
    } catch (const continuum::BadParameter& e) {
      mistakes.attempt([&, &a = a] { reject(a, a.path, e.what()); });
      continue;
    }
    if (!is_default(*info, parameter, value) || filled_by_run(parameter, draft.value.study)) {
      choice.settings[parameter] = value;
    }
  }
  // A study that varies the model's settings looks at every combination itself.
  if (!study_of(draft.value).varies_models) {
    if (const auto found = continuum::find_without_effect(*info, choice.settings)) {
      const Assignment& a = table.at(found->parameter);
      reject(a, a.path, found->refusal);
    }
  }
  return choice;
}

std::map<std::string, ModelChoice> read_models(const Draft& draft, MistakeList& mistakes) {
  std::map<std::string, ModelChoice> out;
  if (draft.models.size() > kMostModels) {
    reject(written(draft, "compare.models"), "model",
           fmt::format("found {} tables [model.LABEL], allowed: up to {}", draft.models.size(),
                       kMostModels));
  }
  for (const auto& [label, table] : draft.models) {
    mistakes.attempt([&, &label = label, &table = table] {
      out.emplace(label, read_model(draft, label, table, mistakes));
    });
  }
  return out;
}

void choose_models(Draft& draft) {
  MistakeList mistakes;
  auto tables = read_models(draft, mistakes);
  mistakes.require_none();
  const Assignment where = written(draft, "compare.models");
  Case& value = draft.value;
  value.models.clear();
  const ModelsElsewhere& instead = study_of(value).models_elsewhere;
  const bool elsewhere = instead.named != nullptr && instead.named(value);
  if (elsewhere && !value.given.contains("compare.models")) model_names(value).clear();
  if (elsewhere && !model_names(value).empty()) {
    reject(where, "compare.models",
           fmt::format("found \"{}\", allowed: none with {}; there NAME:p=0.3 gives a model its "
                       "constants",
                       model_names(value).front(), instead.key));
  }
  std::map<std::string, std::string> seen;  // in small letters
  for (const auto& label : model_names(value)) {
    const auto [other, fresh] = seen.emplace(boost::algorithm::to_lower_copy(label), label);
    if (!fresh && other->second == label) {
      reject(where, "compare.models", "\"" + label + "\" twice");
    }
    if (!fresh) {
      reject(where, "compare.models",
             fmt::format("\"{}\" and \"{}\" differ in small and capital letters only, which some "
                         "file systems do not tell apart",
                         other->second, label));
    }
    const auto table = tables.find(label);
    ModelChoice choice = table != tables.end() ? table->second : ModelChoice{label, label, {}};
    try {
      if (table == tables.end()) choice = in_registry(choice);
      const auto& info = continuum::find_model(choice.name);
      const auto& fills = study_of(value).fills;
      continuum::Settings settings = choice.settings;
      if (info.dim == 0 && std::find(fills.begin(), fills.end(), "dim") != fills.end()) {
        settings.emplace("dim", std::to_string(dimension_of(value)));
      }
      if (study_of(value).has_grains() &&
          continuum::dimension(info, settings) != dimension_of(value)) {
        reject(where, "compare.models",
               fmt::format("\"{}\" is {}-dimensional, the grains are not", label,
                           dimension_of(value) == 2 ? "three" : "two"));
      }
    } catch (const continuum::BadParameter& e) {
      reject(where, "compare.models", e.what());
    }
    value.models.push_back(std::move(choice));
  }
  if (value.models.empty() && !elsewhere && !study_of(value).models_optional)
    reject(where, "compare.models", "found no model, expected one or more");
}

template <class T>
void check_list(const Assignment& where, const Key& key, const std::vector<T>& list) {
  if (list.empty() && !key.may_be_empty) {
    reject(where, key.path(), "found an empty list, expected one or more");
  }
  if (list.size() > kMostEntries) {
    reject(where, key.path(),
           fmt::format("found {} entries, allowed: up to {}", list.size(), kMostEntries));
  }
  if (key.may_repeat) return;
  // As they name curves, fields and keys: numbers to six digits.
  std::map<std::string, T> seen;
  for (const T& entry : list) {
    std::string name;
    if constexpr (std::is_same_v<T, double>) {
      name = fmt::format("{:g}", entry);
    } else {
      name = entry;
    }
    const auto [other, fresh] = seen.emplace(name, entry);
    if (fresh) continue;
    if (other->second != entry) {
      reject(where, key.path(),
             fmt::format("found {} beside {}, allowed: numbers that differ in their first six "
                         "digits, which name figures and curves",
                         entry, other->second));
    }
    reject(where, key.path(), fmt::format("found {} twice, allowed: every entry once", entry));
  }
}

// Every list that the study reads, given or not. `section`: only this one's.
void check_lists(const Draft& draft, MistakeList& mistakes, const std::string& section = "") {
  for (const Key& key : keys()) {
    if (!key_applies(key, draft.value.study)) continue;
    if (!section.empty() && key.section != section) continue;
    std::visit(
        [&](auto where) {
          const auto& held = where(const_cast<Case&>(draft.value));  // only read
          using T = std::decay_t<decltype(held)>;
          if constexpr (std::is_same_v<T, std::vector<double>> ||
                        std::is_same_v<T, std::vector<std::string>>) {
            mistakes.attempt([&] { check_list(written(draft, key.path()), key, held); });
          }
        },
        key.where);
  }
}

// Does it, and blames what it throws, "KEY: ...", on the line where the key was written.
template <class Judge>
void blame(const Draft& draft, const Judge& judge) {
  try {
    judge();
  } catch (const std::invalid_argument& e) {
    const std::string what = e.what();
    throw std::invalid_argument(written(draft, what.substr(0, what.find(':'))).origin + ": " +
                                what);
  }
}

// Every setup that the study's keys reach: from here on a case is only read.
void make_setups(Case& value) {
  for (const Key& key : keys()) {
    if (key_applies(key, value.study)) std::visit([&](auto where) { where(value); }, key.where);
  }
}

// What only the discrete elements know, such as the stable time step.
void check_grains(const Draft& draft) {
  const Study& study = study_of(draft.value);
  if (!study.has_grains()) return;
  check_points(draft);
  blame(draft, [&] { require_models(draft.value.models, dimension_of(draft.value)); });
  // Each of a sweep's many members has a part of the draws.
  const std::int64_t draws =
      std::max(kLeastDraws, kMostDraws / static_cast<std::int64_t>(draft.members));
  dem::Outlook outlook;
  blame(draft, [&] { outlook = study.foresee(draft.value, draws); });
  check_steps(draft, outlook);
  check_memory(draft, outlook);
}

// A doubtful value is named before what follows from it.
void check_grains_or_doubt(const Draft& draft) {
  try {
    check_grains(draft);
  } catch (const std::invalid_argument& e) {
    const std::vector<Doubt> found = doubts(draft);
    const std::string what = e.what();
    if (found.empty() || what.find(found.front().key + ":") != std::string::npos) throw;
    throw std::invalid_argument(found.front().text + "; with it " + what);
  }
}

}  // namespace

Assignment written(const Draft& draft, const std::string& path) {
  const auto at = draft.last.find(path);
  if (at != draft.last.end()) return at->second;
  Assignment none;
  none.path = path;
  none.origin = draft.file;
  return none;
}

void check_section(const Draft& draft, const std::string& section) {
  MistakeList mistakes;
  check_lists(draft, mistakes, section);
  mistakes.require_none();
}

void check_keys(const Draft& draft, MistakeList& mistakes) {
  check_sections(draft, mistakes);
  mistakes.attempt([&] { read_models(draft, mistakes); });
  // Names without a table of their own. Lists are checked later: one that was refused is empty.
  Draft copy = draft;
  for (const std::string& label : model_names(copy.value)) {
    if (draft.models.count(label) > 0) continue;
    mistakes.attempt([&] {
      try {
        continuum::find_model(in_registry({label, label, {}}).name);
      } catch (const continuum::BadParameter& e) {
        reject(written(draft, "compare.models"), "compare.models", e.what());
      }
    });
  }
}

std::vector<std::string>& model_names(Case& value) {
  const Study* study = find_study(value.study);
  return study != nullptr && study->models_optional ? value.compare.optional : value.compare.models;
}

void finish(Draft& draft) {
  draft.value.without_effect.clear();
  make_setups(draft.value);
  if (draft.value.variants.size() > kMostEntries) {
    reject(written(draft, "sweep.key"), "variant",
           fmt::format("found {} tables [variant.NAME], allowed: up to {}",
                       draft.value.variants.size(), kMostEntries));
  }
  MistakeList mistakes;
  check_sections(draft, mistakes);
  mistakes.require_none();
  check_dimensions(draft);
  check_units(draft);
  blame(draft, [&] { follow_material(draft.value); });
  choose_models(draft);
  check_lists(draft, mistakes);
  mistakes.require_none();
  if (const Study& study = study_of(draft.value); study.check != nullptr) {
    blame(draft, [&] { study.check(draft.value); });
  }
  check_grains_or_doubt(draft);
  check_sweep(draft);
  for (const Doubt& doubt : doubts(draft)) draft.value.without_effect.push_back(doubt.text);
  for (const auto& [path, a] : draft.last) {
    const Key& key = *find_key(path);
    if (!is_without_effect(key, draft.value)) continue;
    draft.value.without_effect.push_back(
        fmt::format("{}: {}: {}", a.origin, path, without_effect_text(key, draft.value)));
  }
  const Key* swept = find_key(draft.value.sweep.key);
  if (swept != nullptr) {
    const auto set = draft.last.find(swept->path());
    if (set != draft.last.end() && set->second.from_command_line()) {
      reject(set->second, swept->path(),
             fmt::format("this case sweeps it ({}), so that the value would count nowhere; set "
                         "sweep.values=[...] instead",
                         fmt::join(draft.value.sweep.values, ", ")));
    }
  }
  // Its members differ in nothing but their names.
  if (swept != nullptr && is_without_effect(*swept, draft.value)) {
    draft.value.without_effect.push_back(
        fmt::format("{}: sweep.key: {} {}", written(draft, "sweep.key").origin, swept->path(),
                    without_effect_text(*swept, draft.value)));
  }
  const Study& study = study_of(draft.value);
  if (study.left_unused == nullptr) return;
  blame(draft, [&] {
    const std::string text = study.left_unused(draft.value);
    if (!text.empty()) draft.value.without_effect.push_back(text);
  });
}

}  // namespace grainfield::coupling
