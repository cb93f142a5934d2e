#include "continuum/without_effect.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

std::string beside_other_words(const Words& needed, const Settings& settings) {
  const auto& [other, words] = needed;
  const std::string& found = settings.at(other);
  if (std::find(words.begin(), words.end(), found) != words.end()) return {};
  return fmt::format("with {0} = {1}; leave it out or set {0} = {2}", other, found,
                     fmt::join(words, " or "));
}

}  // namespace

std::string without_effect_because(const ModelInfo& info, const std::string& parameter,
                                   const Settings& complete) {
  for (const Parameter& one : info.parameters)
    if (one.name == parameter && one.only_with) return beside_other_words(*one.only_with, complete);
  return info.without_effect ? info.without_effect(parameter, complete) : std::string();
}

std::string replaced_by(const std::string& other, const Settings& complete,
                        const std::string& what) {
  return fmt::format("beside {} = {}, which replaces {}; leave one of the two out", other,
                     complete.at(other), what);
}

std::optional<SettingWithoutEffect> find_without_effect(const ModelInfo& info,
                                                        const Settings& given) {
  const Settings all = complete(info, given);
  for (const auto& [parameter, value] : given) {
    const std::string because = without_effect_because(info, parameter, all);
    if (!because.empty())
      return SettingWithoutEffect{parameter, fmt::format("model {}: {} = {} has no effect {}",
                                                         info.name, parameter, value, because)};
  }
  return std::nullopt;
}

}  // namespace grainfield::continuum
