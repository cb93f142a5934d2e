#include "dem/space/lane_width.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace grainfield::dem {
namespace {

bool has(int width) {
  if (width == 2) return true;
#if defined(__x86_64__)
  if (width == 4) return __builtin_cpu_supports("avx2") != 0;
  if (width == 8) {
    return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
           __builtin_cpu_supports("avx512vl") != 0;
  }
#endif
  return false;
}

int first_choice() {
  int most = 8;
  if (const char* asked = std::getenv("GRAINFIELD_LANES"); asked != nullptr) {
    const std::string word = asked;
    if (word != "2" && word != "4" && word != "8") {
      throw std::invalid_argument(
          fmt::format("GRAINFIELD_LANES: found \"{}\", allowed: 2, 4, 8", word));
    }
    most = word[0] - '0';
  }
  int width = 2;
  while (2 * width <= most && has(2 * width)) width *= 2;
  return width;
}

std::atomic<int>& chosen() {
  static std::atomic<int> width = first_choice();
  return width;
}

}  // namespace

int lane_width() { return chosen().load(std::memory_order_relaxed); }

bool use_lane_width(int width) {
  if (!has(width)) return false;
  chosen() = width;
  return true;
}

}  // namespace grainfield::dem
