// Options that are numbers with a unit.
#pragma once
#include <string>
#include <vector>

#include "coupling/app/commands.h"

namespace grainfield::coupling {

struct OptionUnits {
  std::vector<std::string> units;  ///< its kinds; a number without unit is in SI, of angles degrees
  std::string meaning;             ///< for messages: "a length in m"
  std::string example;             ///< "80 mm"
};

OptionUnits option_length();
OptionUnits option_angle();
OptionUnits option_force();
OptionUnits option_time();
/// Of grains, in the plane per area too: where lengths across count as 1 m.
OptionUnits weight_per_volume(int dim);
OptionUnits mass_per_volume();

/// Throws std::invalid_argument "NAME: found ..., expected a length in m, or with its unit ...".
double quantity_of(const std::string& name, const std::string& text, const OptionUnits& quantity);

/// An option that is such a quantity: a number, or one with its unit, "80 mm"; of lists each.
CLI::Option* add_quantity(CLI::App& command, const std::string& name, double& to,
                          const OptionUnits& quantity, const std::string& meaning);
CLI::Option* add_quantities(CLI::App& command, const std::string& name, std::vector<double>& to,
                            const OptionUnits& quantity, const std::string& meaning);

}  // namespace grainfield::coupling
