// Neighbour search: who is near whom, and in which order the bodies lie.
#pragma once
#include <cmath>
#include <utility>
#include <vector>

#include "dem/contacts/margins.h"
#include "dem/engine/world.h"
#include "dem/neighbours/hierarchical_grid.h"
#include "dem/shapes/bounding_rectangle.h"

namespace grainfield::dem {

template <class World>
class Search {
 public:
  static constexpr int dim = World::dim;
  using Pair = typename World::Pair;
  using Memory = typename World::Memory;

  /// `skin`: given, m, or 0 for one that adapts itself to the motion.
  Search(World& world, double skin, int threads)
      : world_(world), given_skin_(skin), threads_(threads) {}

  /// Makes the list of near pairs anew; what contacts remember goes on. by_motion: because grains
  /// have left their margins, or have not for long.
  void run(bool by_motion) {
    auto& contacts = world_.contacts;
    auto& sleepers = world_.sleepers;
    // By the grains' ids: the order of the bodies changes below. What has frozen since is not
    // among them.
    const auto kept = contacts.kept_pairs(world_.grains.ids, [&](int i, int j) {
      return sleepers.is_asleep(i) && sleepers.is_asleep(j);
    });
    const auto wall_kept =
        contacts.kept_walls(world_.grains.ids, [&](int i) { return sleepers.is_asleep(i); });
    world_.gather_touches();

    world_.awake = sleepers.part(world_.awake, [this](int i, int j) { world_.grains.swap(i, j); });
    adapt_skin(by_motion);
    const int n = world_.awake;
    bin_awake();
    if (n > 0) {
      const std::vector<int> order = grid_.order();
      world_.grains.sort(order);
      sleepers.sort(order);
      bin_awake();
    }
    world_.locate_applied();
    if (sleepers.have_changed()) bin_sleepers();
    find_bounds(0, n);
    list_pairs(kept);
    list_walls(wall_kept);
    contacts.finish();
    divide();
    world_.margins.resize(n);
    for (int i = 0; i < n; ++i) {
      const double way = reaches_[i].reach - world_.grains.bodies[i].radius;
      world_.margins[i] = {world_.grains.bodies[i].position, world_.rotation(i), turning_of(i),
                           way};
    }
    world_.search_needed = false;
  }

  /// Blocks of the threads. After run(), or after a list has come from an image.
  void divide() { world_.contacts.blocks.divide(world_.contacts.pairs, world_.awake, threads_); }

  /// Of the bodies from `awake` on. Reviews ask near_sleepers between searches.
  void bin_sleepers() {
    std::vector<Reach<dim>> still;
    still.reserve(world_.grains.bodies.size() - static_cast<std::size_t>(world_.awake));
    for (int j = world_.awake; j < world_.grains.size(); ++j) {
      const auto& b = world_.grains.bodies[j];
      still.push_back({b.position, b.radius, b.inverse_mass == 0});
    }
    sleepers_grid_.build(still);
    find_bounds(world_.awake, world_.grains.size());
    world_.sleepers.settled();
  }
  /// Bodies behind the awake ones within `reach` of a point.
  std::vector<int> near_sleepers(const VectorOf<dim>& at, double reach) const {
    std::vector<int> found;
    sleepers_grid_.near({at, reach, false}, found);
    for (int& j : found) j += world_.awake;
    return found;
  }

  const Skin& skin() const { return skin_; }
  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    Skin::visit(self.skin_, each);
  }

 private:
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

  void bin_awake() {
    const int n = world_.awake;
    reaches_.resize(n);
    for (int i = 0; i < n; ++i) {
      const auto& b = world_.grains.bodies[i];
      const double speed = length_of(b.velocity) + turning_of(i) * size_of(b.spin);
      reaches_[i] = {b.position, b.radius + skin_.way(speed, b.radius, world_.time_step),
                     b.inverse_mass == 0};
    }
    grid_.build(reaches_);
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
  bool out_of_reach(int i, int j) const {
    if constexpr (World::Shape::outlines) {
      return world_.grains.shapes.any_slender() && apart(bounds_[i], bounds_[j]);
    }
    return false;
  }

  void list_pairs(const Kept<Memory>& kept) {
    const int n = world_.awake, all = world_.grains.size();
    auto& pairs = world_.contacts.pairs;
    std::vector<std::pair<int, int>> found;
    grid_.pairs(found);
    std::vector<int> near;
    pairs.clear();
    std::size_t next = 0;
    for (int i = 0; i < n; ++i) {
      for (; next < found.size() && found[next].first == i; ++next) {
        if (!out_of_reach(i, found[next].second)) pairs.add(pair_of(i, found[next].second, kept));
      }
      if (all > n) {
        near.clear();
        sleepers_grid_.near(reaches_[i], near);
        for (const int j : near) {
          if (!out_of_reach(i, n + j)) pairs.add(pair_of(i, n + j, kept));
        }
      }
      pairs.end_row();
    }
  }

  void list_walls(const Kept<Memory>& kept) {
    auto& walls = world_.contacts.walls;
    walls.clear();
    for (int i = 0; i < world_.awake; ++i) {
      const auto& b = world_.grains.bodies[i];
      for (int w = 0; w < world_.walls.size() && b.inverse_mass != 0; ++w) {
        if (!(world_.walls.plane(w).height(b.position) < reaches_[i].reach)) continue;
        Pair pair;
        pair.j = w;
        pair.memory = recalled(wall_key(world_.grains.ids[i], w), kept).memory;
        walls.add(pair);
      }
      walls.end_row();
    }
  }

  Pair pair_of(int i, int j, const Kept<Memory>& kept) {
    const auto& ids = world_.grains.ids;
    Pair pair;
    pair.j = j;
    const typename World::Frozen before = recalled(pair_key(ids[i], ids[j]), kept);
    pair.memory = seen_from(before.memory, ids[i] > ids[j]);
    // A sleeper feels what was frozen anew from now on.
    if (j >= world_.awake) world_.sleepers.release(j, seen_from(before.force, ids[j] > ids[i]));
    return pair;
  }

  /// The memory of the last pairs, or of the frozen contact, which is no more then; its force.
  typename World::Frozen recalled(PairKey key, const Kept<Memory>& kept) {
    typename World::Frozen before;
    if (const Memory* memory = kept.find(key)) {
      before.memory = *memory;
    } else if (!world_.sleepers.frozen.empty()) {
      world_.sleepers.frozen.take(key, before);
    }
    return before;
  }

  World& world_;
  double given_skin_;
  int threads_;
  Skin skin_;
  HierarchicalGrid<dim> grid_, sleepers_grid_;
  std::vector<Reach<dim>> reaches_;        // of the awake
  std::vector<BoundingRectangle> bounds_;  // while some grain is slender
};

}  // namespace grainfield::dem
