// Pairs in rows: all those of the first grain, then all of the second, ...
#pragma once
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace grainfield::dem {

/// Pairs k of row i: first(i) <= k < last(i).
template <class Pair>
class Rows {
 public:
  int rows() const { return static_cast<int>(start_.size()) - 1; }
  int size() const { return start_.empty() ? 0 : start_.back(); }
  int first(int i) const { return start_[static_cast<std::size_t>(i)]; }
  int last(int i) const { return start_[static_cast<std::size_t>(i) + 1]; }
  /// Also of the idle pairs behind the last row.
  Pair& operator[](int k) { return pairs_[static_cast<std::size_t>(k)]; }
  const Pair& operator[](int k) const { return pairs_[static_cast<std::size_t>(k)]; }

  void clear() {
    pairs_.clear();
    start_.assign(1, 0);
  }
  void add(const Pair& pair) { pairs_.push_back(pair); }
  void end_row() { start_.push_back(static_cast<int>(pairs_.size())); }
  /// Rows of these lengths. What the pairs are is to be said.
  void set_rows(const std::vector<int>& lengths) {
    start_.resize(lengths.size() + 1);
    start_[0] = 0;
    std::partial_sum(lengths.begin(), lengths.end(), start_.begin() + 1);
    pairs_.resize(static_cast<std::size_t>(size()));
  }
  /// So many idle pairs behind the last row, that may be looked at ahead of time.
  void pad(int idle) {
    pairs_.resize(static_cast<std::size_t>(size()));
    pairs_.resize(static_cast<std::size_t>(size()) + idle);
  }
  std::size_t with_idle() const { return pairs_.size(); }

  /// each(value) for all that a checkpoint holds.
  template <class Self, class Each>
  static void visit(Self& self, Each each) {
    each(self.pairs_);
    each(self.start_);
  }
  /// That this is `rows` rows with `idle` pairs behind them: a broken checkpoint may say anything.
  bool fits(int rows, int idle) const {
    return start_.size() == static_cast<std::size_t>(rows) + 1 && start_.front() == 0 &&
           std::is_sorted(start_.begin(), start_.end()) &&
           pairs_.size() ==
               static_cast<std::size_t>(start_.back()) + static_cast<std::size_t>(idle);
  }
  /// Rows within the pairs, at most `rows` of them, and holds(pair) for every pair of a row.
  template <class Holds>
  bool are_sound(int rows, Holds holds) const {
    if (start_.empty()) return true;
    return start_.size() <= static_cast<std::size_t>(rows) + 1 && start_.front() == 0 &&
           std::is_sorted(start_.begin(), start_.end()) &&
           static_cast<std::size_t>(start_.back()) <= pairs_.size() &&
           std::all_of(pairs_.begin(), pairs_.begin() + start_.back(), holds);
  }

 private:
  std::vector<Pair> pairs_;
  std::vector<int> start_;  // of the rows, and the end; empty before the first search
};

}  // namespace grainfield::dem
