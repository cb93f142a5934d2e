// Names that fits give to models of the registry, so that every command takes what another prints.
#pragma once
#include <string>
#include <vector>

#include "coupling/models/choice.h"

namespace grainfield::coupling {

/// "cantelaube_minus" is the registry's cantelaube with branch = minus.
struct FitName {
  std::string name;
  std::string registry;       ///< empty: a description, which fits alone have
  continuum::Settings fixed;  ///< what the name says
  std::string needs;          ///< the number that its fit finds, without which there is no model
};

/// Those that the registry does not have itself: of heaps, then of layers.
const std::vector<FitName>& fit_names();
/// The one of this name, or null.
const FitName* find_fit_name(const std::string& name);

/// The choice with the registry's name and with what its name says among its settings. Throws
/// continuum::BadParameter for a description, a setting that its name says already, and a number
/// that is missing.
ModelChoice in_registry(ModelChoice choice);

}  // namespace grainfield::coupling
