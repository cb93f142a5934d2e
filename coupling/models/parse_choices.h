// Models and their settings as the user writes them.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "coupling/models/choice.h"

namespace grainfield::coupling {

/// {"nu=0.3", "base=rough"} as settings. Throws std::invalid_argument "WHERE: ..." for other forms
/// and for a parameter given twice.
continuum::Settings parse_settings(const std::vector<std::string>& texts, const std::string& where);

/// One of parse_choices. Throws std::invalid_argument "WHERE: ...".
ModelChoice parse_choice(const std::string& text, const std::string& where = "--model");
/// The label, or behind one that is taken _2, _3, ...; from now on it is taken.
std::string label_beside(std::set<std::string>& taken, const std::string& label);

/// NAME, NAME:p=v,... or LABEL=NAME:p=v,..., each with a label of its own: of one named before with
/// _2, _3, ... behind it. Throws std::invalid_argument "--model: ...", also for unknown models.
std::vector<ModelChoice> parse_choices(const std::vector<std::string>& texts);

}  // namespace grainfield::coupling
