// What contacts remember of rolling and twisting: beside the list of near pairs, only where some
// pair of materials resists, so that runs without pay nothing for it.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "dem/contacts/kept.h"
#include "dem/laws/rolling.h"

namespace grainfield::dem {

template <int D>
struct RollingContacts {
  using Memory = RollingMemory<D>;
  /// Memory of a frozen contact, or a snapshot's until the next search; seen from the grain of
  /// lower id.
  struct Told {
    PairKey key = 0;
    Memory memory;
  };

  bool on = false;
  std::vector<Memory> pairs, walls;  ///< as the list of contacts has them
  std::vector<Told> told;            ///< by keys, after sort()

  void sort() {
    std::sort(told.begin(), told.end(), [](const Told& a, const Told& b) { return a.key < b.key; });
  }
  /// Memory of a contact that is in no list; empty when nothing is known of it.
  Memory told_of(PairKey key) const {
    const auto it = std::lower_bound(told.begin(), told.end(), key,
                                     [](const Told& a, PairKey b) { return a.key < b; });
    return it != told.end() && it->key == key ? it->memory : Memory{};
  }

  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    each(self.pairs);
    each(self.walls);
    each(self.told);
  }
  bool fits(std::size_t pair_count, std::size_t wall_count) const {
    if (!on) return pairs.empty() && walls.empty() && told.empty();
    return pairs.size() == pair_count && walls.size() == wall_count;
  }
};

/// Takes the memories out of the lists before a search, and puts them back after it; those of
/// frozen contacts are told from then on.
template <class World>
class CarryRolling {
 public:
  using Memory = RollingMemory<World::dim>;

  explicit CarryRolling(World& world) : world_(world) {
    auto& rolling = world.rolling;
    if (!rolling.on) return;
    const auto& ids = world.grains.ids;
    take(world.contacts.pairs, rolling.pairs, [&](int i, int j, const Memory& memory) {
      kept_.add(pair_key(ids[i], ids[j]), seen_from(memory, ids[i] > ids[j]));
    });
    take(world.contacts.walls, rolling.walls,
         [&](int i, int slot, const Memory& memory) { kept_.add(wall_key(ids[i], slot), memory); });
    for (const auto& told : rolling.told) kept_.add(told.key, told.memory);
    rolling.told.clear();
    kept_.sort();
  }
  /// After the new list is there.
  void put_back() {
    auto& rolling = world_.rolling;
    if (!rolling.on) return;
    const auto& ids = world_.grains.ids;
    fill(world_.contacts.pairs, rolling.pairs, [&](int i, int j) {
      return seen_from(recalled(pair_key(ids[i], ids[j])), ids[i] > ids[j]);
    });
    fill(world_.contacts.walls, rolling.walls,
         [&](int i, int slot) { return recalled(wall_key(ids[i], slot)); });
    kept_.visit([&](PairKey key, const Memory& memory) {
      if (world_.sleepers.frozen.has(key)) rolling.told.push_back({key, memory});
    });
  }

 private:
  Memory recalled(PairKey key) const {
    const Memory* memory = kept_.find(key);
    return memory == nullptr ? Memory{} : *memory;
  }
  template <class Rows, class Visit>
  static void take(const Rows& rows, const std::vector<Memory>& memories, Visit visit) {
    if (memories.size() < static_cast<std::size_t>(rows.size())) return;
    for (int i = 0; i < rows.rows(); ++i) {
      for (int k = rows.first(i); k < rows.last(i); ++k) {
        if (!memories[k].empty()) visit(i, rows[k].j, memories[k]);
      }
    }
  }
  template <class Rows, class Recall>
  static void fill(const Rows& rows, std::vector<Memory>& memories, Recall recall) {
    memories.assign(rows.with_idle(), {});
    for (int i = 0; i < rows.rows(); ++i) {
      for (int k = rows.first(i); k < rows.last(i); ++k) memories[k] = recall(i, rows[k].j);
    }
  }

  World& world_;
  Kept<Memory> kept_;
};

}  // namespace grainfield::dem
