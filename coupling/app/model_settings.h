// Model settings as the user types them.
#pragma once
#include <string>
#include <vector>

#include "continuum/model.h"

namespace grainfield::coupling {

/// {"nu=0.3", "base=rough"} as settings. Throws std::invalid_argument "WHERE: ..." for other forms
/// and for a parameter given twice.
continuum::Settings parse_settings(const std::vector<std::string>& texts, const std::string& where);

}  // namespace grainfield::coupling
