// Models of fits as a case or a command line names them: one of the lists by its name, or
// NAME, NAME:p=free,q=0.3 or LABEL=NAME:... of the registry.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "coupling/fit/registry_entry.h"
#include "coupling/models/choice.h"

namespace grainfield::coupling {

/// What the specimen tells a model of the registry.
using FactsOf = std::function<RunFacts(const std::string& registry)>;

/// What keys say that accept open models.
inline constexpr const char* kOpenModels =
    "NAME:p=free,q=0.3 or LABEL=NAME:... of a closed model of the plane that `grainfield model` "
    "lists";

/// Whether this is a model of such a fit; no_model: a word that is neither in a list nor in the
/// registry.
ModelText check_heap_model(const std::string& text);
ModelText check_layer_model(const std::string& text);

/// The entries these texts name, in their order; `known`: of the list. Those of the registry are
/// labelled as parse_choices labels them, and by no name of the list. `height`: m per unit of the
/// fit's lengths. Throws std::invalid_argument for other names and what is refused.
std::vector<RegistryEntry> chosen_entries(const std::vector<std::string>& texts,
                                          const std::vector<RegistryEntry>& known,
                                          const FactsOf& facts, double height);

}  // namespace grainfield::coupling
