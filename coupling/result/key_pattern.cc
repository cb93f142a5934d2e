#include "coupling/result/key_pattern.h"

#include <cctype>
#include <cstddef>

namespace grainfield::coupling {
namespace {

// From here on.
bool matches_from(const std::string& pattern, const std::string& text, std::size_t p,
                  std::size_t t) {
  if (p == pattern.size()) return t == text.size();
  if (pattern[p] != '*') {
    return t < text.size() && pattern[p] == text[t] && matches_from(pattern, text, p + 1, t + 1);
  }
  const auto digit = [&](std::size_t k) {
    return k < text.size() && std::isdigit(static_cast<unsigned char>(text[k])) != 0;
  };
  const bool end = p == 0 || p + 1 == pattern.size();
  for (std::size_t k = t; k < text.size(); ++k) {
    const bool of_a_number = k > t && digit(k - 1) && digit(k + 1);
    if (text[k] == '.' && !end && !of_a_number) return false;
    if (matches_from(pattern, text, p + 1, k + 1)) return true;
  }
  return false;
}

}  // namespace

bool matches(const std::string& pattern, const std::string& text) {
  return matches_from(pattern, text, 0, 0);
}

}  // namespace grainfield::coupling
