// Neighbour search: who is near whom, and in which order the bodies lie.
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "dem/contacts/margins.h"
#include "dem/contacts/pairs_before.h"
#include "dem/engine/thread_team.h"
#include "dem/engine/world.h"
#include "dem/engine/wrap.h"
#include "dem/neighbours/hierarchical_grid.h"
#include "dem/shapes/bounding_rectangle.h"

namespace grainfield::dem {

template <class World>
class Search {
 public:
  static constexpr int dim = World::dim;
  using Pair = typename World::Pair;
  using Memory = typename World::Memory;
  using Feature = typename World::Acting::Feature;

  /// `skin`: given, m, or 0 for one that adapts itself to the motion.
  Search(World& world, double skin, ThreadTeam& team)
      : world_(world), given_skin_(skin), team_(team) {}

  /// Makes the list of near pairs anew; what contacts remember goes on. by_motion: because grains
  /// have left their margins, or have not for long.
  void run(bool by_motion) {
    auto& contacts = world_.contacts;
    auto& sleepers = world_.sleepers;
    // By the grains' ids: the order of the bodies changes below.
    const auto wall_kept =
        contacts.kept_walls(world_.grains.ids, [&](int i) { return sleepers.is_asleep(i); });
    const auto wall_normals =
        contacts.kept_normals(world_.grains.ids, [&](int k) { return world_.remembers_wall(k); });
    CarryAccounts<World> accounts(world_);
    CarryRolling<World> rolling(world_);
    world_.gather_touches();

    before_.take(contacts.pairs, world_.grains.ids, !world_.cell.is_periodic(),
                 World::sleepers_first);
    world_.awake = sleepers.part(world_.awake, [this](int i, int j) { world_.grains.swap(i, j); });
    settle_cell(world_);
    adapt_skin(by_motion);
    const int n = world_.awake;
    find_reaches();
    if (n > 0) {
      const std::vector<int> order = HierarchicalGrid<dim>::order(reaches_);
      world_.grains.sort(order, team_);
      sleepers.sort(order);
      find_reaches();
    }
    grid_.build(reaches_);
    world_.locate_applied();
    if (sleepers.have_changed()) bin_sleepers();
    find_bounds(0, n);
    list_pairs();
    set_wall_margins();
    list_walls(wall_kept, wall_normals);
    contacts.finish(world_.cell.is_periodic());
    accounts.put_back();
    rolling.put_back();
    world_.margins.resize(n);
    for (int i = 0; i < n; ++i) {
      const double way = reaches_[i].reach - world_.grains.bodies[i].radius;
      world_.margins[i] = {world_.grains.bodies[i].position, world_.rotation(i), turning_of(i),
                           way};
    }
    world_.all_round = true;
    if constexpr (dim == 3) {
      for (int i = 0; i < n; ++i) world_.all_round &= is_round(world_.grains.inertias[i]);
    }
    world_.search_needed = false;
    prepare();
  }

  /// Blocks of the threads and what else a checkpoint does not hold. Part of run(), or after a list
  /// has come from a checkpoint.
  void prepare() {
    world_.contacts.divide(world_.awake, team_.size(), World::sleepers_first);
    if constexpr (requires { world_.grains.shapes.ways(); }) {
      world_.contacts.list_pairs_to_evaluate(world_.awake, team_.size());
      world_.grains.shapes.start_ways(world_.grains.bodies.data());
    }
    if constexpr (dim == 3) {
      world_.round_margins.clear();
      for (const auto& m : world_.margins) {
        world_.round_margins.push_back({{m.position[0], m.position[1], m.position[2]}, m.way});
      }
    }
  }

  /// Bins the bodies from `awake` on. Reviews ask near_sleepers between searches.
  void bin_sleepers() {
    std::vector<Reach<dim>> still;
    still.reserve(world_.grains.bodies.size() - static_cast<std::size_t>(world_.awake));
    for (int j = world_.awake; j < world_.grains.size(); ++j) {
      const auto& b = world_.grains.bodies[j];
      still.push_back({b.position, b.radius, b.inverse_mass == 0});
    }
    sleepers_grid_.build(still);
    farthest_sleeper_ = farthest_of(still);
    find_bounds(world_.awake, world_.grains.size());
    world_.sleepers.settled();
  }
  /// Bodies behind the awake ones within `reach` of a point.
  std::vector<int> near_sleepers(const VectorOf<dim>& at, double reach) const {
    std::vector<int> found;
    sleepers_grid_.near({at, reach, false}, found);
    visit_images(at, reach + farthest_sleeper_, [&](const PairImage& n) {
      sleepers_grid_.near({at + world_.cell.shift(n), reach, false}, found);
    });
    for (int& j : found) j += world_.awake;
    return found;
  }

  const Skin& skin() const { return skin_; }
  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    Skin::visit(self.skin_, each);
  }

 private:
  /// A pair of which the second one is an image.
  struct Crossing {
    int i = 0, j = 0;
    PairImage image{};
  };

  static double farthest_of(const std::vector<Reach<dim>>& grains) {
    double farthest = 0;
    for (const auto& g : grains) farthest = std::max(farthest, g.reach);
    return farthest;
  }
  template <class Visit>
  void visit_images(const VectorOf<dim>& at, double reach, Visit visit) const {
    if (world_.cell.is_periodic()) world_.cell.visit_images(at, reach, visit);
  }

  void adapt_skin(bool by_motion) {
    skin_.adapt(by_motion, world_.steps);
    double sum = 0;
    for (int i = 0; i < world_.awake; ++i) sum += world_.grains.bodies[i].radius;
    skin_.set(given_skin_, world_.awake == 0 ? 0 : sum / world_.awake);
  }

  /// How far turning by one radian carries a point of the grain, m; 0 where its circle is what the
  /// search goes by.
  double turning_of(int i) const {
    if constexpr (World::Shape::outlines) {
      return world_.grains.shapes.slender(i) ? world_.grains.bodies[i].radius : 0;
    }
    return 0;
  }

  void find_reaches() {
    const int n = world_.awake;
    reaches_.resize(n);
    for (int i = 0; i < n; ++i) {
      const auto& b = world_.grains.bodies[i];
      const double speed = length_of(world_.fluctuation(i)) + turning_of(i) * size_of(b.spin);
      double way = skin_.way(speed, b.radius, world_.time_step);
      // Then no grain is near another, or itself, by two images.
      if (world_.cell.is_periodic()) {
        way = std::min(way, 0.25 * world_.cell.shortest() - b.radius);
      }
      reaches_[i] = {b.position, b.radius + way, b.inverse_mass == 0};
    }
  }

  /// The bounds of these bodies: of those awake with the way that they may go.
  void find_bounds(int first, int last) {
    if constexpr (World::Shape::outlines) {
      const auto& grains = world_.grains;
      if (!grains.shapes.any_slender()) return;
      bounds_.resize(grains.bodies.size());
      for (int i = first; i < last; ++i) {
        const double gap = i < world_.awake ? reaches_[i].reach - grains.bodies[i].radius : 0;
        bounds_[i] = grains.shapes.bound(i, grains.bodies[i], world_.rotation(i), gap);
      }
    }
  }

  /// True when the two, whose circles meet, cannot touch until the next search: one of them is
  /// slender and lies beside the other.
  bool out_of_reach(int i, int j, const PairImage& image = {}) const {
    if constexpr (World::Shape::outlines) {
      if (!world_.grains.shapes.any_slender()) return false;
      if (!is_image(image)) return apart(bounds_[i], bounds_[j]);
      const VectorOf<dim> shift = world_.cell.shift(image);
      BoundingRectangle there = bounds_[j];
      there.x += shift.x();
      there.y += shift.y();
      return apart(bounds_[i], there);
    }
    return false;
  }

  /// The pairs that cross the cell's faces, each once, by their first and then their second grain;
  /// the latter, the image, may lie behind the awake.
  void find_crossing() {
    crossing_.clear();
    if (!world_.cell.is_periodic()) return;
    const int n = world_.awake, all = world_.grains.size();
    const double farthest = std::max(farthest_of(reaches_), all > n ? farthest_sleeper_ : 0);
    std::vector<int> near;
    for (int i = 0; i < n; ++i) {
      visit_images(reaches_[i].centre, reaches_[i].reach + farthest, [&](const PairImage& image) {
        Reach<dim> there = reaches_[i];
        there.centre += world_.cell.shift(image);
        near.clear();
        if (world_.cell.is_forward(image)) grid_.near(there, near);
        for (const int j : near) {
          if (i < j) crossing_.push_back({i, j, opposite(image)});
          if (j < i) crossing_.push_back({j, i, image});
        }
        near.clear();
        if (all > n) sleepers_grid_.near(there, near);
        for (const int j : near) crossing_.push_back({i, n + j, opposite(image)});
      });
    }
    std::sort(crossing_.begin(), crossing_.end(), [](const Crossing& a, const Crossing& b) {
      return a.i != b.i ? a.i < b.i : a.j < b.j;
    });
  }

  /// A pair of the list to be, in row after row.
  struct Near {
    int j = 0;
    PairImage image{};
  };
  /// What a thread makes of the list: no two of them share a line of the cache.
  struct alignas(64) Part {
    IndexPairs found, sorted;
    std::vector<Near> near;
  };

  void list_pairs() {
    auto& contacts = world_.contacts;
    const bool periodic = world_.cell.is_periodic();
    const int n = world_.awake, threads = team_.size();
    find_crossing();
    parts_.resize(static_cast<std::size_t>(threads));
    lengths_.assign(static_cast<std::size_t>(n), 0);
    team_.together([&](int rank) {
      const auto [first, last] = share(n, rank, threads);
      grid_.find_pairs(first, last, parts_[rank].found);
    });
    team_.together([&](int rank) {
      const auto [first, last] = share(n, rank, threads);
      find_rows(first, last, parts_[rank]);
    });
    contacts.pairs.set_rows(lengths_);
    contacts.images.resize(periodic ? static_cast<std::size_t>(contacts.pairs.size()) : 0);
    team_.together([&](int rank) {
      const auto [first, last] = share(n, rank, threads);
      const Near* next = parts_[rank].near.data();
      for (int i = first; i < last; ++i) {
        for (int k = contacts.pairs.first(i); k < contacts.pairs.last(i); ++k, ++next) {
          contacts.pairs[k] = pair_of(i, next->j);
          if (periodic) contacts.images[k] = next->image;
        }
      }
    });
    if (n < world_.grains.size() || !world_.sleepers.frozen.empty()) thaw_pairs();
  }
  /// The rows of bodies [first, last): whom they have near, and how many.
  void find_rows(int first, int last, Part& part) {
    const int n = world_.awake;
    const bool sleepers = world_.grains.size() > n;
    std::vector<Near>& near = part.near;
    near.clear();
    std::vector<std::span<const std::pair<int, int>>> found;
    for (const Part& one : parts_) found.emplace_back(one.found);
    grid_.sort_pairs(found, first, last, part.sorted);
    auto next = part.sorted.begin();
    auto crossing = std::partition_point(crossing_.begin(), crossing_.end(),
                                         [&](const Crossing& pair) { return pair.i < first; });
    std::vector<int> asleep;
    for (int i = first; i < last; ++i) {
      const std::size_t before = near.size();
      const auto add = [&](int j, const PairImage& image) {
        if (!out_of_reach(i, j, image)) near.push_back({j, image});
      };
      const auto add_sleepers = [&] {
        asleep.clear();
        if (sleepers) sleepers_grid_.near(reaches_[i], asleep);
        for (const int j : asleep) add(n + j, {});
      };
      if (World::sleepers_first) add_sleepers();
      for (; next != part.sorted.end() && next->first == i; ++next) add(next->second, {});
      if (!World::sleepers_first) add_sleepers();
      for (; crossing != crossing_.end() && crossing->i == i; ++crossing) {
        add(crossing->j, crossing->image);
      }
      lengths_[i] = static_cast<int>(near.size() - before);
    }
  }
  /// Contacts of grains that have woken remember what was frozen; a sleeper feels what was frozen
  /// anew from now on.
  void thaw_pairs() {
    auto& pairs = world_.contacts.pairs;
    auto& sleepers = world_.sleepers;
    const auto& ids = world_.grains.ids;
    for (int i = 0; i < pairs.rows(); ++i) {
      for (int k = pairs.first(i); k < pairs.last(i); ++k) {
        Pair& pair = pairs[k];
        typename World::Frozen before;
        if (pair.memory.empty() && sleepers.frozen.take(pair_key(ids[i], ids[pair.j]), before)) {
          pair.memory = seen_from(before.memory, ids[i] > ids[pair.j]);
        }
        if (pair.j >= world_.awake) {
          sleepers.release(pair.j, seen_from(before.force, ids[pair.j] > ids[i]));
        }
      }
    }
  }

  /// How far the walls that move may go until the next search.
  void set_wall_margins() {
    auto& walls = world_.walls;
    if (!walls.any_driven()) return;
    double sum = 0;
    for (int i = 0; i < world_.awake; ++i) sum += world_.grains.bodies[i].radius;
    const double mean = world_.awake == 0 ? 0 : sum / world_.awake;
    for (int w = 0; w < walls.size(); ++w) {
      if (!walls.is_driven(w)) continue;
      double lever = 0;
      for (int i = 0; i < world_.awake; ++i) {
        const auto& at = world_.grains.bodies[i].position;
        lever = std::max(lever, walls.lever(w, at, reaches_[i].reach));
      }
      walls.set_margin(w, lever, 0);
      const double way = skin_.way(walls.speed(w), mean, world_.time_step);
      // A few steps at full speed at least: a margin left at once would be none.
      const double least = 4 * world_.time_step * walls.top_speed(w);
      walls.set_margin(w, lever, std::max(way, least));
    }
  }

  void list_walls(const Kept<Memory>& kept, const Kept<typename World::Vector>& normals) {
    auto& walls = world_.contacts.walls;
    walls.clear();
    auto& wall_normals = world_.contacts.wall_normals;
    wall_normals.clear();
    for (int i = 0; i < world_.awake; ++i) {
      const auto& b = world_.grains.bodies[i];
      for (int w = 0; w < world_.walls.size() && b.inverse_mass != 0; ++w) {
        const double reach = reaches_[i].reach + world_.walls.way(w);
        if (!world_.walls.is_near(w, b.position, reach)) continue;
        const int first = world_.walls.first_slot(w);
        for (int slot = first; slot < first + world_.walls.slots_of(w); ++slot) {
          const PairKey key = wall_key(world_.grains.ids[i], slot);
          Pair pair;
          pair.j = slot;
          pair.memory = recalled(key, kept);
          walls.add(pair);
          const auto* normal = normals.find(key);
          wall_normals.push_back(normal != nullptr ? *normal : World::Vector::Zero());
        }
      }
      walls.end_row();
    }
  }

  /// With what it remembers of the last list.
  Pair pair_of(int i, int j) const {
    const auto [before, turned] = before_.find(world_.grains.ids[i], world_.grains.ids[j]);
    Pair pair;
    pair.j = j;
    if (before == nullptr) return pair;
    if (!before->memory.empty()) pair.memory = seen_from(before->memory, turned);
    if constexpr (requires(const Feature& feature) { feature.reversed(); }) {
      if (!before->feature.empty()) pair.feature = seen_from(before->feature, turned);
    }
    return pair;
  }

  /// At a wall: the memory of the last list, or of the frozen contact, which is no more then.
  Memory recalled(PairKey key, const Kept<Memory>& kept) {
    if (const Memory* memory = kept.find(key)) return *memory;
    typename World::Frozen before;
    if (!world_.sleepers.frozen.empty()) world_.sleepers.frozen.take(key, before);
    return before.memory;
  }

  World& world_;
  double given_skin_;
  ThreadTeam& team_;
  Skin skin_;
  HierarchicalGrid<dim> grid_, sleepers_grid_;
  double farthest_sleeper_ = 0;      // largest reach of those in the grid
  std::vector<Reach<dim>> reaches_;  // of the awake
  std::vector<Crossing> crossing_;
  std::vector<Part> parts_;   // by threads
  std::vector<int> lengths_;  // of the rows
  PairsBefore<Pair> before_;
  bool had_sleepers_ = true;               // in the last list
  std::vector<BoundingRectangle> bounds_;  // while some grain is slender
};

}  // namespace grainfield::dem
