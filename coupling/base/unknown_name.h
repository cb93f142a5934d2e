// Error texts for names that do not exist.
#pragma once
#include <string>
#include <vector>

namespace grainfield::coupling {

/// "unknown kernel \"lucky\"; known: lucy, gaussian, heaviside; did you mean \"lucy\"?"
std::string unknown_name(const std::string& what, const std::string& found,
                         const std::vector<std::string>& known);

}  // namespace grainfield::coupling
