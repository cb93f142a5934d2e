// Results never replace what they are made of.
#pragma once
#include <string>
#include <vector>

namespace grainfield::coupling {

/// Throws std::invalid_argument "OPTION: FILE is an input; ..." when `output` names one of the
/// input files, under any path.
void require_other_file(const std::string& option, const std::string& output,
                        const std::vector<std::string>& inputs);

}  // namespace grainfield::coupling
