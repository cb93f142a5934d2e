// The last list of near pairs: what it knows of a pair is found again by the grains' ids after the
// bodies have changed their order.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "dem/contacts/rows.h"

namespace grainfield::dem {

template <class Pair>
class PairsBefore {
 public:
  struct Found {
    const Pair* pair = nullptr;  ///< null: they were not near
    bool turned = false;         ///< its first grain is the second one now
  };

  /// Takes the pairs of bodies with these ids; what is left in `pairs` is to be overwritten.
  /// `ascend`: in every row, by the second grain (no images are behind).
  void take(Rows<Pair>& pairs, const std::vector<std::int64_t>& ids, bool ascend) {
    std::swap(pairs_, pairs);
    ascend_ = ascend;
    where_.resize(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) where_[ids[i]] = static_cast<int>(i);
  }
  /// Of the grains with these ids.
  Found find(std::int64_t first, std::int64_t second) const {
    const int a = where_[first], b = where_[second];
    const int row = std::min(a, b), other = std::max(a, b);
    if (row >= pairs_.rows()) return {};
    int k = pairs_.first(row);
    if (ascend_) {  // a large grain has a long row
      for (int length = pairs_.last(row) - k; length > kLongRow;) {
        const int half = length / 2;
        if (pairs_[k + half].j <= other) k += half;
        length -= half;
      }
    }
    for (; k < pairs_.last(row) && !(ascend_ && pairs_[k].j > other); ++k) {
      if (pairs_[k].j == other) return {&pairs_[k], a > b};
    }
    return {};
  }

 private:
  static constexpr int kLongRow = 16;

  Rows<Pair> pairs_;
  bool ascend_ = false;
  std::vector<int> where_;  // body by id
};

}  // namespace grainfield::dem
