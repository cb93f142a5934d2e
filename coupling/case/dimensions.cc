#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "coupling/case/doubts.h"
#include "coupling/case/study.h"

namespace grainfield::coupling {
namespace {

bool contains(const std::vector<std::string>& all, const std::string& word) {
  return std::find(all.begin(), all.end(), word) != all.end();
}

// "the grains of study = "NAME" are in 2D with NAME.dim = 2".
std::string whose(const Case& value) {
  const Study& study = study_of(value);
  std::string out =
      fmt::format("the grains of study = \"{}\" are in {}D", study.name, dimension_of(value));
  if (const Key* key = find_key(study.dimension_key)) {
    out += fmt::format(" with {} = {}", key->path(), value_text(*key, value));
  }
  return out;
}

void check_word(const Draft& draft, const Key& key) {
  const bool plane = dimension_of(draft.value) == 2;
  const auto& wrong = plane ? key.space_words : key.plane_words;
  const auto* where = std::get_if<std::string& (*)(Case&)>(&key.where);
  if (wrong.empty() || where == nullptr) return;
  const std::string& word = (*where)(const_cast<Case&>(draft.value));  // only read
  if (!contains(wrong, word) || is_without_effect(key, draft.value)) return;
  std::vector<std::string> right;
  for (const std::string& choice : key.choices) {
    if (!contains(wrong, choice)) right.push_back(choice);
  }
  reject(written(draft, key.path()), key.path(),
         fmt::format("found \"{}\", allowed: {}; only in {} dimensions: {}; {}", word,
                     fmt::join(right, " | "), plane ? "three" : "two", fmt::join(wrong, ", "),
                     whose(draft.value)));
}

}  // namespace

void check_dimensions(const Draft& draft) {
  const Study& study = study_of(draft.value);
  const std::string& varied = draft.value.sweep.key;
  // Each member of the sweep is looked at by itself.
  if (varied == "variant" || (!varied.empty() && varied == study.dimension_key)) return;
  for (const auto& [path, a] : draft.last) {
    const Key& key = *find_key(path);
    if (!key.space || dimension_of(draft.value) == 3) continue;
    reject(a, path,
           fmt::format("found {}, allowed: only in three dimensions: {}; {}",
                       value_text(key, draft.value), allowed(key), whose(draft.value)));
  }
  for (const Key& key : keys()) {
    if (key_applies(key, study.name) && varied != key.path()) check_word(draft, key);
  }
}

}  // namespace grainfield::coupling
