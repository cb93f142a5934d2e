// Parameters that have no effect beside others: said to the user, not passed over.
#pragma once
#include <optional>
#include <string>

#include "continuum/model.h"

namespace grainfield::continuum {

/// Why a parameter of the model has no effect with these settings (as complete() returns them) and
/// what to do, e.g. "with base = rough; leave it out or set base = elastic"; empty: it has one.
std::string without_effect_because(const ModelInfo& info, const std::string& parameter,
                                   const Settings& complete);

/// "beside OTHER = VALUE, which replaces WHAT; leave one of the two out", for
/// ModelInfo::without_effect.
std::string replaced_by(const std::string& other, const Settings& complete,
                        const std::string& what = "it");

/// A given setting without effect.
struct SettingWithoutEffect {
  std::string parameter;
  std::string refusal;  ///< "model NAME: PARAMETER = VALUE has no effect ..."
};
/// The first of the given settings that has no effect; none: all have one. Throws BadParameter as
/// complete().
std::optional<SettingWithoutEffect> find_without_effect(const ModelInfo& info,
                                                        const Settings& given);

}  // namespace grainfield::continuum
