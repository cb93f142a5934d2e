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

/// "osl:eta=0.7,mu=-0.3,bcc" as the choices it lists: behind a comma another one begins, unless a
/// setting p=v of a choice with settings does.
std::vector<std::string> split_choices(const std::string& text);

/// One of parse_choices, with the registry's name where fits have another (fit_names.h). Throws
/// std::invalid_argument "WHERE: ...".
ModelChoice parse_choice(const std::string& text, const std::string& where = "--model");
/// The label, or behind one that is taken _2, _3, ...; from now on it is taken.
std::string label_beside(std::set<std::string>& taken, const std::string& label);

/// NAME, NAME:p=v,... or LABEL=NAME:p=v,..., or several of these parted by commas, each with a
/// label of its own: of one named before with _2, _3, ... behind it. Throws std::invalid_argument
/// "--model: ...", also for unknown models.
std::vector<ModelChoice> parse_choices(const std::vector<std::string>& texts);

}  // namespace grainfield::coupling
