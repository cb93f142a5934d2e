// What a case would take: refused where no machine could give it, else told.
#pragma once
#include <cstdint>
#include <string>

#include "coupling/case/apply.h"
#include "dem/run/outlook.h"

namespace grainfield::coupling {

/// Grains that reading a case draws to judge its realizations, in all: less than a second's worth.
inline constexpr std::int64_t kMostDraws = 300'000;

/// Throws std::invalid_argument "ORIGIN: KEY: ..." for more time steps or grain steps than can be
/// taken, naming the key to which they are due.
void check_steps(const Draft& draft, const dem::Outlook& outlook);
/// The same for more memory than a process may take here (coupling/base/memory.h).
void check_memory(const Draft& draft, const dem::Outlook& outlook);
/// The same for more averaged values than can be kept: points times realizations.
void check_points(const Draft& draft);

/// Members, realizations, grains, time step, steps, memory: lines for people, empty for a study
/// without grains.
std::string outlook_text(const Case& value);

}  // namespace grainfield::coupling
