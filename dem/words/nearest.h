// Words that a user may have meant.
#pragma once
#include <string>
#include <vector>

namespace grainfield::dem {

/// The one of `known`, not empty, that takes the fewest edits to get from `found`.
std::string nearest_of(const std::string& found, const std::vector<std::string>& known);

/// Throws std::invalid_argument: `KEY: found "lineer", allowed: overlap_area, energy, linear; did
/// you mean "linear"?`
[[noreturn]] void refuse_word(const std::string& key, const std::string& found,
                              const std::vector<std::string>& allowed);
/// The same, unless `found` is one of them.
void check_word(const std::string& key, const std::string& found,
                const std::vector<std::string>& allowed);

}  // namespace grainfield::dem
