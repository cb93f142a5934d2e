// What contacts remember, found again by the grains' ids after the bodies have changed their order.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "dem/contacts/pair_key.h"

namespace grainfield::dem {

/// Memories as seen from the grain with the lower id.
template <class Memory>
class Kept {
 public:
  void add(PairKey key, const Memory& memory) { list_.emplace_back(key, memory); }
  /// After the last add, before the first find.
  void sort() {
    std::sort(list_.begin(), list_.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
  }
  /// Null: nothing was kept.
  const Memory* find(PairKey key) const {
    const auto it = std::lower_bound(list_.begin(), list_.end(), key,
                                     [](const auto& a, PairKey b) { return a.first < b; });
    return it != list_.end() && it->first == key ? &it->second : nullptr;
  }
  /// visit(key, memory), by keys.
  template <class Visit>
  void visit(Visit visit) const {
    for (const auto& [key, memory] : list_) visit(key, memory);
  }

 private:
  std::vector<std::pair<PairKey, Memory>> list_;
};

/// The same memory seen from the other grain, when `other`.
template <class Memory>
Memory seen_from(const Memory& memory, bool other) {
  return other ? memory.reversed() : memory;
}

}  // namespace grainfield::dem
