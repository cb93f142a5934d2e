// What contacts remember, found again by the grains' ids after the bodies have changed their order.
#pragma once
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "dem/contacts/pair_key.h"

namespace grainfield::dem {

/// Memories as seen from the grain with the lower id.
template <class Memory>
class Kept {
 public:
  void add(PairKey key, const Memory& memory) { list_.emplace_back(key, memory); }
  /// After the last add, before the first find. In proportion to the number of memories and to the
  /// largest id.
  void sort() {
    std::int64_t most = -1;
    for (const auto& [key, memory] : list_) most = std::max(most, first_of(key));
    start_.assign(static_cast<std::size_t>(most + 2), 0);
    for (const auto& [key, memory] : list_) ++start_[first_of(key) + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    std::vector<int> next(start_.begin(), start_.end());
    std::vector<std::pair<PairKey, Memory>> sorted(list_.size());
    for (const auto& kept : list_) sorted[next[first_of(kept.first)]++] = kept;
    list_.swap(sorted);
    for (std::size_t id = 0; id + 1 < start_.size(); ++id) {
      std::sort(list_.begin() + start_[id], list_.begin() + start_[id + 1],
                [](const auto& a, const auto& b) { return a.first < b.first; });
    }
  }
  /// Null: nothing was kept.
  const Memory* find(PairKey key) const {
    const auto id = static_cast<std::size_t>(first_of(key));
    if (id + 1 >= start_.size()) return nullptr;
    const auto last = list_.begin() + start_[id + 1];
    const auto it = std::lower_bound(list_.begin() + start_[id], last, key,
                                     [](const auto& a, PairKey b) { return a.first < b; });
    return it != last && it->first == key ? &it->second : nullptr;
  }
  /// visit(key, memory), by keys.
  template <class Visit>
  void visit(Visit visit) const {
    for (const auto& [key, memory] : list_) visit(key, memory);
  }

 private:
  std::vector<std::pair<PairKey, Memory>> list_;
  std::vector<int> start_;  // of each lower id in the list, and the end
};

/// The same memory seen from the other grain, when `other`.
template <class Memory>
Memory seen_from(const Memory& memory, bool other) {
  return other ? memory.reversed() : memory;
}

}  // namespace grainfield::dem
