// Patterns of the keys of summary.json and of the figures of models.
#pragma once
#include <string>

namespace grainfield::coupling {

/// '*' matches a name: text that is not empty, whose only dots are those of numbers (0.98). At an
/// end of the pattern it is another figure's key, which is looked up, and has its dots.
bool matches(const std::string& pattern, const std::string& text);

}  // namespace grainfield::coupling
