// Factors of matrices of blocks beside dense ones of the same numbers.
#include "dem/implicit/block_lu.h"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <set>

#include "dem/random/random.h"
#include "dem/space/lane_width.h"

namespace grainfield::dem {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

Pairs some_pairs(int n, Random& random) {
  std::set<std::pair<int, int>> out;
  for (int k = 0; k < 2 * n; ++k) {
    const int i = static_cast<int>(random.uniform(0, n)),
              j = static_cast<int>(random.uniform(0, n));
    if (i != j && out.count({j, i}) == 0) out.insert({i, j});
  }
  return {out.begin(), out.end()};
}

// The pattern stays while pairs come and go, and with them blocks of the fill.
TEST(BlockLu, SolvesWithAnyOfItsBlocksZero) {
  Random random(7);
  for (int n = 1; n <= 40; ++n) {
    const Pairs pairs = some_pairs(n, random);
    BlockLu matrix;
    matrix.lay_out(n, pairs);
    for (const double there : {1.0, 0.5, 0.2, 0.0, 0.8}) {
      matrix.clear();
      Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * n, 3 * n);
      const auto fill = [&](int i, int j) {
        BlockLu::Block block = matrix.at(matrix.place(i, j));
        for (int k = 0; k < 9; ++k) block(k % 3, k / 3) = random.uniform(-1, 1);
        if (i == j) block.diagonal().array() += 3.0 * n;
        dense.block<3, 3>(3 * i, 3 * j) = block;
      };
      for (int k = 0; k < n; ++k) fill(k, k);
      for (const auto& [i, j] : pairs) {
        if (random.uniform(0, 1) >= there) continue;
        fill(i, j);
        fill(j, i);
      }
      Eigen::VectorXd rhs(3 * n), x;
      for (int k = 0; k < 3 * n; ++k) rhs[k] = random.uniform(-1, 1);
      ASSERT_TRUE(matrix.factorize());
      matrix.solve(rhs, x);
      EXPECT_LT((x - dense.partialPivLu().solve(rhs)).norm(), 1e-13) << n << " " << there;
    }
  }
}

TEST(BlockLu, TellsASingularMatrix) {
  BlockLu matrix;
  matrix.lay_out(2, {{0, 1}});
  matrix.clear();
  EXPECT_FALSE(matrix.factorize());
  matrix.clear();
  for (const int i : {0, 1}) {
    for (const int j : {0, 1}) matrix.at(matrix.place(i, j)).setIdentity();
  }
  EXPECT_FALSE(matrix.factorize());
}

TEST(BlockLu, HasTheSameBitsAtAnyWidth) {
  const int before = lane_width();
  std::vector<Eigen::VectorXd> found;
  for (const int width : {2, 4, 8}) {
    if (!use_lane_width(width)) continue;
    Random random(8);
    const int n = 60;
    const Pairs pairs = some_pairs(n, random);
    BlockLu matrix;
    matrix.lay_out(n, pairs);
    matrix.clear();
    const auto fill = [&](int i, int j, double more) {
      BlockLu::Block block = matrix.at(matrix.place(i, j));
      for (int k = 0; k < 9; ++k) block(k % 3, k / 3) = random.uniform(-1, 1);
      block.diagonal().array() += more;
    };
    for (int k = 0; k < n; ++k) fill(k, k, 12);
    for (const auto& [i, j] : pairs) fill(i, j, 0), fill(j, i, 0);
    ASSERT_TRUE(matrix.factorize());
    matrix.solve(Eigen::VectorXd::LinSpaced(3 * n, -1, 1), found.emplace_back());
  }
  use_lane_width(before);
  if (found.size() < 2) GTEST_SKIP() << "this processor has one width";
  for (const Eigen::VectorXd& x : found) EXPECT_EQ(x, found[0]);
}

}  // namespace
}  // namespace grainfield::dem
