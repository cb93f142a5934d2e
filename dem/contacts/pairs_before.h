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
  /// `ascend`: in every row, by the second grain (no images are behind); with `sleepers_first`
  /// those behind the rows' come first.
  void take(Rows<Pair>& pairs, const std::vector<std::int64_t>& ids, bool ascend,
            bool sleepers_first = false) {
    std::swap(pairs_, pairs);
    ascend_ = ascend;
    before_ = sleepers_first ? static_cast<int>(ids.size()) : 0;
    where_.resize(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) where_[ids[i]] = static_cast<int>(i);
  }
  /// The pair of the grains with these ids.
  Found find(std::int64_t first, std::int64_t second) const {
    const int a = where_[first], b = where_[second];
    const int row = std::min(a, b), other = std::max(a, b);
    if (row >= pairs_.rows()) return {};
    int k = pairs_.first(row);
    if (ascend_) {  // a large grain has a long row
      for (int length = pairs_.last(row) - k; length > kLongRow;) {
        const int half = length / 2;
        if (place_of(pairs_[k + half].j) <= place_of(other)) k += half;
        length -= half;
      }
    }
    for (; k < pairs_.last(row) && !(ascend_ && place_of(pairs_[k].j) > place_of(other)); ++k) {
      if (pairs_[k].j == other) return {&pairs_[k], a > b};
    }
    return {};
  }

 private:
  static constexpr int kLongRow = 16;

  /// By which the pairs of a row ascend.
  int place_of(int j) const { return j < pairs_.rows() ? j : j - before_; }

  Rows<Pair> pairs_;
  bool ascend_ = false;
  int before_ = 0;
  std::vector<int> where_;  // body by id
};

}  // namespace grainfield::dem
