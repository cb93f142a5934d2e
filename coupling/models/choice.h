// A model as a case or a command line names it.
#pragma once
#include <string>

#include "continuum/model.h"

namespace grainfield::coupling {

/// A model of the comparison: its label in tables and keys, the registry's name, and the settings
/// the user gave (F, h and dim are added from the run where the model has them).
struct ModelChoice {
  std::string label;
  std::string name;
  continuum::Settings settings;
};

}  // namespace grainfield::coupling
