// The name of a contact, whatever the order of the bodies: the ids of two grains, or of a grain and
// the number of a wall.
#pragma once
#include <algorithm>
#include <cstdint>

namespace grainfield::dem {

using PairKey = std::uint64_t;

/// Key of two grains; ids are below 2^31.
inline PairKey pair_key(std::int64_t a, std::int64_t b) {
  const auto low = static_cast<PairKey>(std::min(a, b)),
             high = static_cast<PairKey>(std::max(a, b));
  return low << 32 | high;
}
/// Key of a grain and a wall: walls count down from the largest number, where no id comes.
inline PairKey wall_key(std::int64_t id, int wall) {
  return static_cast<PairKey>(id) << 32 | (0xFFFFFFFFu - static_cast<PairKey>(wall));
}

/// The lower id, or the grain's.
inline std::int64_t first_of(PairKey key) { return static_cast<std::int64_t>(key >> 32); }
/// The higher id; of a contact with a wall no id.
inline std::int64_t second_of(PairKey key) {
  return static_cast<std::int64_t>(static_cast<std::uint32_t>(key));
}
/// The wall, or -1 when it is none of that many.
inline int wall_of(PairKey key, int walls) {
  const std::uint32_t wall = 0xFFFFFFFFu - static_cast<std::uint32_t>(key);
  return wall < static_cast<std::uint32_t>(walls) ? static_cast<int>(wall) : -1;
}

}  // namespace grainfield::dem
