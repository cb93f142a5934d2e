#include "coupling/app/quantity_option.h"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "coupling/unit.h"
#include "dem/snapshot/number.h"

namespace grainfield::coupling {
namespace {

std::string unit_complaint(const std::string& text, const OptionUnits& quantity) {
  return fmt::format("found \"{}\", expected {}, or with its unit, \"{}\"", text, quantity.meaning,
                     quantity.example);
}

CLI::Validator in_si_units(const OptionUnits& quantity) {
  return CLI::Validator(
      [quantity](std::string& text) -> std::string {
        if (text.find(' ') == std::string::npos && dem::parse_number(text)) return "";
        const std::optional<double> value = parse_quantity(text, quantity.units);
        if (!value) return unit_complaint(text, quantity);
        text = fmt::format("{}", *value);
        return "";
      },
      "");
}

}  // namespace

OptionUnits option_length() { return {{"m"}, "a length in m", "80 mm"}; }
OptionUnits option_angle() { return {{"deg"}, "an angle in degrees", "0.5 rad"}; }
OptionUnits option_force() { return {{"N"}, "a force in N", "2 kN"}; }
OptionUnits option_time() { return {{"s"}, "a time in s", "2 us"}; }

OptionUnits weight_per_volume(int dim) {
  if (dim == 3) return {{"N/m3"}, "a weight per volume in N/m3", "15 kN/m3"};
  return {{"N/m3", "N/m2"}, "a weight per volume in N/m3 (2D: N/m2)", "15 kN/m3"};
}

OptionUnits mass_per_volume() {
  return {{"kg/m3", "kg/m2"}, "a density in kg/m3 (2D: kg/m2)", "2.5 g/cm3"};
}

double quantity_of(const std::string& name, const std::string& text, const OptionUnits& quantity) {
  const std::optional<double> value = parse_quantity(text, quantity.units);
  if (!value) throw std::invalid_argument(name + ": " + unit_complaint(text, quantity));
  return *value;
}

CLI::Option* add_quantity(CLI::App& command, const std::string& name, double& to,
                          const OptionUnits& quantity, const std::string& meaning) {
  return command.add_option(name, to, meaning)->transform(in_si_units(quantity));
}

CLI::Option* add_quantities(CLI::App& command, const std::string& name, std::vector<double>& to,
                            const OptionUnits& quantity, const std::string& meaning) {
  return command.add_option(name, to, meaning)->delimiter(',')->transform(in_si_units(quantity));
}

}  // namespace grainfield::coupling
