// The list of near pairs by itself: rows, what is found again by ids, blocks of threads, margins.
#include "dem/contacts/contact_list.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

#include "dem/contacts/margins.h"
#include "dem/contacts/pairs_before.h"
#include "dem/random/random.h"

namespace grainfield::dem {
namespace {

// A memory with a direction, as springs in space have one.
struct Arrow {
  double size = 0;
  bool empty() const { return size == 0; }
  Arrow reversed() const { return {-size}; }
};
struct NoFeature {};
using List = ContactList<2, Arrow, NoFeature>;

TEST(ContactList, KeysTellPairsAndWallsApart) {
  EXPECT_EQ(pair_key(7, 3), pair_key(3, 7));
  EXPECT_NE(pair_key(3, 7), pair_key(3, 8));
  EXPECT_EQ(first_of(pair_key(7, 3)), 3);
  EXPECT_EQ(second_of(pair_key(7, 3)), 7);
  EXPECT_EQ(wall_of(pair_key(7, 3), 4), -1);
  EXPECT_EQ(wall_of(wall_key(5, 2), 4), 2);
  EXPECT_EQ(wall_of(wall_key(5, 2), 2), -1);
  EXPECT_EQ(first_of(wall_key(5, 2)), 5);
}

TEST(ContactList, MemoriesAreFoundAgainFromEitherSide) {
  List list;
  list.clear();
  const std::vector<std::int64_t> ids{5, 2, 9};
  list.pairs.add({{1.5}, 1, {}});  // 5 with 2: seen from the higher id
  list.pairs.add({{0}, 2, {}});    // empty: not kept
  list.pairs.end_row();
  list.pairs.add({{-4}, 2, {}});  // 2 with 9
  list.pairs.end_row();
  list.pairs.end_row();
  list.walls.add({{8}, 1, {}});
  for (int row = 0; row < 3; ++row) list.walls.end_row();
  list.finish();
  EXPECT_EQ(list.pairs.rows(), 3);
  EXPECT_EQ(list.pairs.size(), 3);
  EXPECT_EQ(list.pairs.with_idle(), 3U + kAhead);
  EXPECT_EQ(list.pair_forces.size(), list.pairs.with_idle());

  EXPECT_EQ(list.kept_walls(ids, [](int) { return false; }).find(wall_key(5, 1))->size, 8);
  EXPECT_FALSE(list.kept_walls(ids, [](int) { return true; }).find(wall_key(5, 1)));

  PairsBefore<List::Pair> before;
  before.take(list.pairs, {1, 0, 2}, true);
  const auto found = before.find(1, 0), turned = before.find(0, 1);
  ASSERT_TRUE(found.pair && turned.pair);
  EXPECT_EQ(found.pair->memory.size, 1.5);
  EXPECT_FALSE(found.turned);
  EXPECT_EQ(turned.pair, found.pair);
  EXPECT_TRUE(turned.turned);
  EXPECT_EQ(before.find(2, 0).pair->memory.size, -4);
  EXPECT_TRUE(before.find(2, 0).turned);
  EXPECT_TRUE(before.find(1, 2).pair->memory.empty());
}

TEST(ContactList, PairsOfLongRowsAreFoundAmongMany) {
  Random random(7);
  for (int seed = 0; seed < 20; ++seed) {
    const int grains = 200, awake = seed % 3 == 0 ? 200 : 150;
    const bool sleepers_first = seed % 4 < 2;
    List list;
    list.clear();
    std::vector<std::vector<double>> sizes(grains, std::vector<double>(grains, 0));
    for (int i = 0; i < awake; ++i) {
      const double share = i < 3 ? 0.9 : 0.03;  // the first three are large
      for (int n = i + 1; n < grains; ++n) {
        const int sleepers = grains - awake;
        const int j = !sleepers_first ? n : n <= i + sleepers ? awake + n - i - 1 : n - sleepers;
        if (random.uniform() > share) continue;
        sizes[i][j] = 1 + i + 1000.0 * j;
        list.pairs.add({{sizes[i][j]}, j, {}});
      }
      list.pairs.end_row();
    }
    for (int row = 0; row < grains; ++row) list.walls.end_row();
    list.finish();
    std::vector<std::int64_t> ids(grains);
    for (int i = 0; i < grains; ++i) ids[i] = (i * 37 + seed) % grains;  // another order
    PairsBefore<List::Pair> before;
    before.take(list.pairs, ids, seed % 2 == 0, sleepers_first);
    for (int i = 0; i < grains; ++i) {
      for (int j = 0; j < grains; ++j) {
        if (i == j) continue;
        const auto found = before.find(ids[i], ids[j]);
        const double size = sizes[std::min(i, j)][std::max(i, j)];
        ASSERT_EQ(found.pair != nullptr, size != 0);
        if (size == 0) continue;
        ASSERT_EQ(found.pair->memory.size, size);
        ASSERT_EQ(found.turned, i > j);
      }
    }
  }
}

// A pair across a face adds to its second grain's account: by the thread that has that grain.
TEST(ContactList, PairsWithImagesAreTheSecondGrainsThreads) {
  const int grains = 120, threads = 4;
  List list;
  list.clear();
  for (int i = 0; i < grains; ++i) {
    list.images.push_back({});
    list.pairs.add({{1}, std::min(i + 30, grains - 1), {}});
    if (i < 60) {
      list.images.push_back({1, 0, 0, 0});
      list.pairs.add({{1}, i + 60, {}});
    }
    list.pairs.end_row();
    list.walls.end_row();
  }
  list.finish(true);
  list.divide(grains, threads);
  int images = 0, others = 0;
  for (int rank = 0; rank < threads; ++rank) {
    const PairsInOrder& crossing = list.blocks.crossing(rank);
    for (int n = 0; n < crossing.count; ++n) {
      const int j = crossing.second[n];
      const bool own = list.blocks.first(rank) <= j && j < list.blocks.last(rank);
      if (is_image(list.images[crossing.pair[n]])) {
        EXPECT_TRUE(own);
        ++images;
      } else {
        others += own ? 0 : 1;
      }
    }
  }
  EXPECT_EQ(images, 60);
  EXPECT_GT(others, 20);
}

TEST(ContactList, NonsenseFromACheckpointIsSeen) {
  List list;
  list.clear();
  list.pairs.add({{1}, 1, {}});
  list.pairs.end_row();
  list.pairs.end_row();
  list.walls.end_row();
  list.walls.end_row();
  list.finish();
  EXPECT_TRUE(list.fits(true, 2, 2, 0));
  EXPECT_FALSE(list.fits(true, 3, 2, 0));  // rows
  EXPECT_FALSE(list.fits(true, 2, 1, 0));  // a grain that is none
  list.felt.pop_back();
  EXPECT_FALSE(list.fits(true, 2, 2, 0));
}

void blocks_share_the_work(bool sleepers_first) {
  Random random(3);
  for (const int threads : {1, 2, 3, 8}) {
    const int grains = 300, all = 330;  // 30 asleep behind
    List list;
    list.clear();
    for (int i = 0; i < grains; ++i) {
      std::vector<int> row;
      for (int n = 0; n < 3; ++n) row.push_back(i + 1 + static_cast<int>(40 * random.uniform()));
      if (sleepers_first) std::partition(row.begin(), row.end(), [](int j) { return j >= grains; });
      for (const int j : row) {
        if (j < all) list.pairs.add({{1}, j, {}});
      }
      list.pairs.end_row();
    }
    list.finish();
    list.divide(grains, threads, sleepers_first);
    EXPECT_EQ(list.blocks.first(0), 0);
    EXPECT_EQ(list.blocks.last(threads - 1), grains);
    std::vector<int> done(list.pairs.size(), 0), swept = done, summed = done, expected = done;
    for (int rank = 0; rank < threads; ++rank) {
      EXPECT_EQ(list.blocks.first(rank), rank == 0 ? 0 : list.blocks.last(rank - 1));
      int work = 0;
      for (int i = list.blocks.first(rank); i < list.blocks.last(rank); ++i) {
        work += 2;
        for (int k = list.pairs.first(i); k < list.pairs.last(i); ++k) {
          const int j = list.pairs[k].j;
          if (j < list.blocks.last(rank) || j >= grains) {
            ++done[k];
            ++work;
          } else {
            ++expected[k];
          }
        }
      }
      const PairsInOrder& inside = list.blocks.inside(rank);
      for (int n = 0; n < inside.count; ++n) ++swept[inside.pair[n]];
      for (const RowTail& tail : list.blocks.tails(rank)) {
        if (tail.row < 0) continue;
        EXPECT_TRUE(tail.before == 0 || inside.first[tail.before - 1] <= tail.row);
        EXPECT_TRUE(tail.before == inside.count || inside.first[tail.before] > tail.row);
        for (int k = tail.from; k < list.pairs.last(tail.row); ++k) {
          ++swept[k];
          EXPECT_TRUE(!sleepers_first || list.pairs[k].j < grains);
        }
      }
      EXPECT_TRUE(list.blocks.across(rank).empty());
      const PairsInOrder& incoming = list.blocks.incoming(rank);
      for (int n = 0; n < incoming.count; ++n) {
        const int i = incoming.first[n], k = incoming.pair[n];
        EXPECT_LT(i, list.blocks.first(rank));
        EXPECT_EQ(list.pairs[k].j, incoming.second[n]);
        EXPECT_GE(list.pairs[k].j, list.blocks.first(rank));
        EXPECT_LT(list.pairs[k].j, list.blocks.last(rank));
        ++summed[k];
      }
      const PairsInOrder& crossing = list.blocks.crossing(rank);
      for (int n = 0; n < crossing.count; ++n) {
        const int i = crossing.first[n], j = crossing.second[n], k = crossing.pair[n];
        EXPECT_EQ(list.pairs[k].j, j);
        EXPECT_TRUE(list.pairs.first(i) <= k && k < list.pairs.last(i));
        const auto own = [&](int grain) {
          return list.blocks.first(rank) <= grain && grain < list.blocks.last(rank);
        };
        EXPECT_NE(own(i), own(j));
        ++done[k];
        ++work;
      }
      // But for the grain that the bound falls on.
      EXPECT_NEAR(work, (list.pairs.size() + 2.0 * grains) / threads, 20);
    }
    EXPECT_THAT(done, testing::Each(1));
    EXPECT_THAT(swept, testing::Each(1));
    EXPECT_EQ(summed, expected);
  }
}

TEST(ContactList, BlocksShareTheWorkAndLoseNoPair) { blocks_share_the_work(false); }

// Pairs with sleepers go side by side with the others, and only those with later blocks are left.
TEST(ContactList, SleepersThatComeFirstAreInNoTail) { blocks_share_the_work(true); }

TEST(ContactList, MarginsAreLeftByMovingAndByTurning) {
  Margin<2> m;
  m.position = {1, 1};
  m.rotation = 0.5;
  m.turning = 0.1;
  m.way = 0.02;
  const Eigen::Vector2d near(1.01, 1), far(1.03, 1);
  EXPECT_FALSE(m.is_left<true>(near, 0.5));
  EXPECT_TRUE(m.is_left<true>(far, 0.5));
  EXPECT_TRUE(m.is_left<true>(near, 0.65));  // 0.01 moved, 0.015 by turning
  EXPECT_FALSE(m.is_left<false>(near, 0.65));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(m.is_left<true>({nan, 1}, 0.5));
  EXPECT_TRUE(m.is_left<true>(near, nan));
}

TEST(ContactList, SkinGrowsWithSearchesAndShrinksWithout) {
  Skin skin;
  skin.set(0, 1);
  EXPECT_DOUBLE_EQ(skin.way(0, 1, 1e-5), 0.5 * kFirstSkin);
  skin.adapt(true, kOften - 1);
  skin.set(0, 1);
  EXPECT_DOUBLE_EQ(skin.way(0, 1, 1e-5), 0.75 * kFirstSkin);
  skin.adapt(false, kOften);  // not by motion: nothing is learnt
  skin.set(0, 1);
  EXPECT_DOUBLE_EQ(skin.way(0, 1, 1e-5), 0.75 * kFirstSkin);
  EXPECT_FALSE(skin.is_too_large(kOften + kSeldom - 10));
  EXPECT_TRUE(skin.is_too_large(kOften + kSeldom));
  skin.adapt(true, kOften + kSeldom);
  skin.set(0, 1);
  EXPECT_DOUBLE_EQ(skin.way(0, 1, 1e-5), 0.375 * kFirstSkin);
  skin.set(0.3, 1);  // given
  EXPECT_DOUBLE_EQ(skin.way(0, 1, 1e-5), 0.15);
  EXPECT_DOUBLE_EQ(skin.way(1e9, 1, 1e-5), 0.15 + kMostAhead);
}

}  // namespace
}  // namespace grainfield::dem
