// Neighbour search: who is near whom, and in which order the bodies lie.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dem/contacts/margins.h"
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
    features_ = contacts.kept_features(world_.grains.ids);
    const auto wall_kept =
        contacts.kept_walls(world_.grains.ids, [&](int i) { return sleepers.is_asleep(i); });
    const auto wall_normals =
        contacts.kept_normals(world_.grains.ids, [&](int k) { return world_.remembers_wall(k); });
    CarryAccounts<World> accounts(world_);
    CarryRolling<World> rolling(world_);
    world_.gather_touches();

    world_.awake = sleepers.part(world_.awake, [this](int i, int j) { world_.grains.swap(i, j); });
    settle_cell(world_);
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

  /// Blocks of the threads and what else an image does not hold. Part of run(), or after a list has
  /// come from an image.
  void prepare() {
    world_.contacts.divide(world_.awake, threads_);
    if constexpr (dim == 3) {
      world_.round_margins.clear();
      for (const auto& m : world_.margins) {
        world_.round_margins.push_back({{m.position[0], m.position[1], m.position[2]}, m.way});
      }
    }
  }

  /// Of the bodies from `awake` on. Reviews ask near_sleepers between searches.
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

  void bin_awake() {
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

  void add_pair(int i, int j, const PairImage& image, const Kept<Memory>& kept) {
    if (out_of_reach(i, j, image)) return;
    world_.contacts.pairs.add(pair_of(i, j, kept));
    if (world_.cell.is_periodic()) world_.contacts.images.push_back(image);
  }

  void list_pairs(const Kept<Memory>& kept) {
    const int n = world_.awake, all = world_.grains.size();
    auto& pairs = world_.contacts.pairs;
    std::vector<std::pair<int, int>> found;
    grid_.pairs(found);
    find_crossing();
    std::vector<int> near;
    pairs.clear();
    world_.contacts.images.clear();
    std::size_t next = 0, next_crossing = 0;
    for (int i = 0; i < n; ++i) {
      for (; next < found.size() && found[next].first == i; ++next) {
        add_pair(i, found[next].second, {}, kept);
      }
      if (all > n) {
        near.clear();
        sleepers_grid_.near(reaches_[i], near);
        for (const int j : near) add_pair(i, n + j, {}, kept);
      }
      for (; next_crossing < crossing_.size() && crossing_[next_crossing].i == i; ++next_crossing) {
        add_pair(i, crossing_[next_crossing].j, crossing_[next_crossing].image, kept);
      }
      pairs.end_row();
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
          pair.memory = recalled(key, kept).memory;
          walls.add(pair);
          const auto* normal = normals.find(key);
          wall_normals.push_back(normal != nullptr ? *normal : World::Vector::Zero());
        }
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
    if constexpr (requires(const Feature& feature) { feature.reversed(); }) {
      const Feature* feature = features_.find(pair_key(ids[i], ids[j]));
      if (feature != nullptr) pair.feature = seen_from(*feature, ids[i] > ids[j]);
    }
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
  double farthest_sleeper_ = 0;      // largest reach of those in the grid
  std::vector<Reach<dim>> reaches_;  // of the awake
  std::vector<Crossing> crossing_;
  Kept<Feature> features_;                 // of the pairs before, within run()
  std::vector<BoundingRectangle> bounds_;  // while some grain is slender
};

}  // namespace grainfield::dem
