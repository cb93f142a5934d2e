// Which grains each thread sweeps, and the pairs that cross from one thread's grains to another's.
#pragma once
#include <utility>
#include <vector>

namespace grainfield::dem {

class Blocks {
 public:
  /// Blocks of about the same number of pairs. The rows are those of the first `grains` bodies; a
  /// pair's second grain behind them belongs to no block.
  template <class Rows>
  void divide(const Rows& rows, int grains, int threads) {
    bounds_.assign(threads + 1, grains);
    bounds_[0] = 0;
    const auto work = [&](int i) {
      return static_cast<long long>(i < grains ? rows.first(i) : rows.size()) + 2LL * i;
    };
    for (int rank = 1, i = 0; rank < threads; ++rank) {
      while (i < grains && work(i) * threads < work(grains) * rank) ++i;
      bounds_[rank] = i;
    }
    incoming_.assign(threads, {});
    for (int from = 0; from + 1 < threads; ++from) {
      for (int i = first(from); i < last(from); ++i) {
        for (int k = rows.first(i); k < rows.last(i); ++k) {
          const int j = rows[k].j;
          if (j < last(from) || j >= grains) continue;
          int to = from + 1;
          while (j >= last(to)) ++to;
          incoming_[to].emplace_back(i, k);
        }
      }
    }
  }

  int first(int rank) const { return bounds_[rank]; }
  int last(int rank) const { return bounds_[rank + 1]; }
  /// (first grain, pair) of the pairs from earlier blocks into this one, in their order.
  const std::vector<std::pair<int, int>>& incoming(int rank) const { return incoming_[rank]; }

 private:
  std::vector<int> bounds_;  // first grain of each block, and the end
  std::vector<std::vector<std::pair<int, int>>> incoming_;
};

}  // namespace grainfield::dem
