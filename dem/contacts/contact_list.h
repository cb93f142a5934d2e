// The list of near pairs, and of grains near walls: what each remembers, and the forces of the last
// step.
#pragma once
#include <cstdint>
#include <vector>

#include "dem/contacts/blocks.h"
#include "dem/contacts/kept.h"
#include "dem/contacts/rows.h"
#include "dem/space/body.h"
#include "dem/space/moving_cell.h"
#include "dem/space/overlap_batch.h"

namespace grainfield::dem {

// How many pairs ahead the sweep asks for the grains it will need; the list ends with as many idle
// entries. Measured: 8 % on packings beyond the second-level cache, none below.
inline constexpr int kAhead = 16;

/// A candidate pair; its first grain is the row's.
template <class Law, class Shape>
struct NearPair {
  Law memory;     ///< of the law, seen from the first grain
  int j = 0;      ///< second grain, or wall
  Shape feature;  ///< of the shapes: where the narrow phase starts
};

/// Pair k of grains i and j, for a thread that evaluates many of them side by side. It is left out
/// while the ways of both grains (shape.h) are together below `until`: the two do not touch, and it
/// has no memory and no force.
struct PairToEvaluate {
  int i = 0, j = 0, k = 0;
  double until = 0;
};

/// Contacts of bodies [0, n) in their order; a second grain may lie behind them (asleep). Such
/// pairs come first in a row or behind those of the awake.
template <int D, class Law, class Shape>
struct ContactList {
  using Pair = NearPair<Law, Shape>;

  Rows<Pair> pairs, walls;
  /// Images of the second grains, by pair; images come last in a row. Empty without a cell.
  std::vector<PairImage> images;
  std::vector<ContactForce<D>> pair_forces, wall_forces;  ///< of the last step of step(n)
  std::vector<ForceSum<D>> felt;  ///< by sleepers, by pair, since the last search
  /// Normals of wall contacts in the step before, to the grain; 0: none, or a plane at rest.
  std::vector<VectorOf<D>> wall_normals;
  // Not in a checkpoint: divide() makes them.
  Blocks blocks;
  std::vector<int> seconds;                              ///< second grains by pair, close together
  std::vector<std::vector<PairToEvaluate>> to_evaluate;  ///< by thread, in the list's order

  void clear() {
    pairs.clear();
    walls.clear();
    images.clear();
    wall_normals.clear();
  }
  /// After finish(): what each thread does.
  void divide(int grains, int threads, bool sleepers_first = false) {
    blocks.divide(pairs, grains, threads, kPairsBehind, sleepers_first,
                  [&](int k) { return !images.empty() && is_image(images[k]); });
    seconds.resize(pairs.with_idle());
    for (std::size_t k = 0; k < seconds.size(); ++k) seconds[k] = pairs[static_cast<int>(k)].j;
  }
  /// After divide(), for shapes whose pairs are evaluated before any sum.
  void list_pairs_to_evaluate(int grains, int threads) {
    to_evaluate.resize(static_cast<std::size_t>(threads));
    for (int rank = 0; rank < threads; ++rank) {
      std::vector<PairToEvaluate>& list = to_evaluate[rank];
      list.clear();
      const PairsInOrder& crossing = blocks.crossing(rank);
      for (int n = 0; n < crossing.count; ++n) {
        list.push_back({crossing.first[n], crossing.second[n], crossing.pair[n]});
      }
      for (int i = blocks.first(rank); i < blocks.last(rank); ++i) {
        for (int k = pairs.first(i); k < pairs.last(i); ++k) {
          const int j = pairs[k].j;
          if (j < blocks.last(rank) || j >= grains) list.push_back({i, j, k});
        }
      }
    }
  }
  /// After the last pair. `with_images`: in a cell. What was felt has been gathered.
  void finish(bool with_images = false) {
    pairs.pad(kAhead);
    const std::size_t idle = pairs.with_idle();
    if (with_images) images.resize(idle);
    // The last step of step(n) writes them all; without one forget_forces() does.
    pair_forces.resize(static_cast<std::size_t>(pairs.size()));
    pair_forces.resize(idle);
    wall_forces.assign(walls.with_idle(), {});
    wall_normals.resize(walls.with_idle(), zero<VectorOf<D>>());
    felt.resize(static_cast<std::size_t>(pairs.size()));
    felt.resize(idle);
  }
  /// Sets the forces of pairs to 0: the list is not that of the last step.
  void forget_forces() { pair_forces.assign(pair_forces.size(), {}); }

  /// Directions of contacts with walls that have a memory: remembers(k).
  template <class Remembers>
  Kept<VectorOf<D>> kept_normals(const std::vector<std::int64_t>& ids, Remembers remembers) const {
    Kept<VectorOf<D>> kept;
    for (int i = 0; i < walls.rows(); ++i) {
      for (int k = walls.first(i); k < walls.last(i); ++k) {
        if (!remembers(k) || wall_normals[k].isZero(0)) continue;
        kept.add(wall_key(ids[i], walls[k].j), wall_normals[k]);
      }
    }
    kept.sort();
    return kept;
  }
  /// The memories in use at walls, by ids. `skip(i)`: those of sleepers, kept elsewhere.
  template <class Skip>
  Kept<Law> kept_walls(const std::vector<std::int64_t>& ids, Skip skip) const {
    Kept<Law> kept;
    for (int i = 0; i < walls.rows(); ++i) {
      for (int k = walls.first(i); k < walls.last(i); ++k) {
        if (walls[k].memory.empty() || skip(i)) continue;
        kept.add(wall_key(ids[i], walls[k].j), walls[k].memory);
      }
    }
    kept.sort();
    return kept;
  }

  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    Rows<Pair>::visit(self.pairs, each);
    Rows<Pair>::visit(self.walls, each);
    each(self.images);
    each(self.pair_forces);
    each(self.wall_forces);
    each(self.felt);
    each(self.wall_normals);
  }
  /// That a broken checkpoint has not made nonsense of it. `searched`: rows of that many grains.
  bool fits(bool searched, int rows, int grains, int wall_count) const {
    const auto within = [](int count) {
      return [count](const Pair& p) { return p.j >= 0 && p.j < count; };
    };
    return pairs.are_sound(grains, within(grains)) && walls.are_sound(grains, within(wall_count)) &&
           pair_forces.size() == pairs.with_idle() && felt.size() == pairs.with_idle() &&
           wall_forces.size() == walls.with_idle() && wall_normals.size() == walls.with_idle() &&
           (images.empty() || images.size() == pairs.with_idle()) &&
           (!searched || (pairs.fits(rows, kAhead) && walls.fits(rows, 0)));
  }
};

}  // namespace grainfield::dem
