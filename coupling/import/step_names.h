// Steps that the names of files tell.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// The step of each of `files`. Among names that differ in one number only ("g_100_s1.vtp",
/// "g_200_s1.vtp"), that number; of any other name, the last number in it ("dump100.vtk"). None:
/// no number, or more than 18 digits. Throws std::invalid_argument where names differ in more than
/// one number, so that none is plainly the step.
std::vector<std::optional<long long>> steps_of_names(const std::vector<std::string>& files);

}  // namespace grainfield::coupling
