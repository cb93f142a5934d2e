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
  double below = 0;  ///< m: the model's surface is so far below that of the grains
};

/// What a text is that may name a model with settings.
struct ModelText {
  enum class Is { no_model, model, refused };
  Is is = Is::no_model;
  std::string why = {};  ///< it is refused
};
using ModelTextCheck = ModelText (*)(const std::string&);

}  // namespace grainfield::coupling
