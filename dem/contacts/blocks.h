// Which grains each thread sweeps, and in which order it does their pairs.
#pragma once
#include <cstddef>
#include <vector>

namespace grainfield::dem {

/// Pairs of the list one after the other, for code that takes many of them side by side.
struct PairsInOrder {
  int count = 0;
  /// Both grains and the index, by place. Behind the last pair it is repeated: what is looked at
  /// beyond it is the thread's own, too.
  std::vector<int> first, second, pair;

  void clear() {
    for (std::vector<int>* list : {&first, &second, &pair}) list->clear();
    count = 0;
  }
  void add(int i, int j, int k) {
    first.push_back(i);
    second.push_back(j);
    pair.push_back(k);
    ++count;
  }
  void repeat_last(int times) {
    for (std::vector<int>* list : {&first, &second, &pair}) {
      if (!list->empty())
        list->resize(list->size() + static_cast<std::size_t>(times), list->back());
    }
  }
};

/// The pairs of a row from `from` on are done by themselves: their second grain is in a later
/// block, an image, or asleep where such pairs are not the first of a row.
struct RowTail {
  int row = -1, from = 0;
  int before = 0;  ///< so many pairs of the block are done side by side before them
};

class Blocks {
 public:
  /// Blocks of about the same work. The rows are those of the first `grains` bodies; a
  /// pair's second grain behind them belongs to no block. is_across(k): the second grain of pair k
  /// is an image; those come last in a row. Behind the last pair of an order `behind` more may be
  /// looked at. `sleepers_first`: pairs with grains behind the rows' are the first of a row, and go
  /// side by side with those inside the block.
  template <class Rows, class IsAcross>
  void divide(const Rows& rows, int grains, int threads, int behind, bool sleepers_first,
              IsAcross is_across) {
    place_bounds(rows, grains, threads, is_across);
    threads_.resize(threads);
    for (Thread& t : threads_) t.clear();
    for (int from = 0; from < threads; ++from) {
      Thread& mine = threads_[from];
      for (int i = first(from); i < last(from); ++i) {
        int end = rows.last(i);
        while (end > rows.first(i) && is_across(end - 1)) --end;
        int tail = end;
        const auto is_alone = [&](int j) {
          return j >= last(from) && !(sleepers_first && j >= grains);
        };
        while (tail > rows.first(i) && is_alone(rows[tail - 1].j)) --tail;
        for (int k = rows.first(i); k < tail; ++k) mine.inside.add(i, rows[k].j, k);
        for (int k = tail; k < end; ++k) {
          if (rows[k].j >= grains) mine.asleep.add(i, rows[k].j, k);
        }
        const RowTail own{i, tail, mine.inside.count};
        if (end < rows.last(i)) {
          mine.across.push_back(own);
        } else if (tail < end) {
          mine.tails.push_back(own);
        }
        for (int k = rows.first(i); k < rows.last(i); ++k) {
          const int j = rows[k].j;
          if (j < last(from) || j >= grains) continue;
          int to = from + 1;
          while (j >= last(to)) ++to;
          threads_[to].incoming.add(i, j, k);
        }
      }
    }
    share_crossing(is_across);
    for (Thread& t : threads_) {
      t.tails.push_back({});  // of no row
      t.inside.repeat_last(behind);
      t.asleep.repeat_last(behind);
      t.crossing.repeat_last(behind);
    }
  }

  int first(int rank) const { return bounds_[rank]; }
  int last(int rank) const { return bounds_[rank + 1]; }
  /// The pairs between two blocks that this thread evaluates. Those with an image are done by the
  /// thread of the second grain; of the others the threads of both grains do half each.
  const PairsInOrder& crossing(int rank) const { return threads_[rank].crossing; }
  /// All pairs from earlier blocks into this one.
  const PairsInOrder& incoming(int rank) const { return threads_[rank].incoming; }
  /// The pairs of this block's rows but for their tails; second grains may sleep.
  const PairsInOrder& inside(int rank) const { return threads_[rank].inside; }
  /// The pairs in the tails of this block's rows whose second grain is asleep or fixed.
  const PairsInOrder& asleep(int rank) const { return threads_[rank].asleep; }
  /// Ends of rows without images, and of those with some. The first ones end with one of no
  /// row.
  const std::vector<RowTail>& tails(int rank) const { return threads_[rank].tails; }
  const std::vector<RowTail>& across(int rank) const { return threads_[rank].across; }

 private:
  struct Thread {
    PairsInOrder inside, asleep, incoming, crossing;
    std::vector<RowTail> tails, across;

    void clear() {
      for (PairsInOrder* order : {&inside, &asleep, &incoming, &crossing}) order->clear();
      tails.clear();
      across.clear();
    }
  };

  template <class Rows, class IsAcross>
  void place_bounds(const Rows& rows, int grains, int threads, IsAcross is_across) {
    bounds_.assign(threads + 1, grains);
    bounds_[0] = 0;
    // Half a pair belongs to each of its grains, one with an image to the second, whose thread
    // evaluates it; a grain's motion takes as long as two pairs.
    std::vector<long long> work(static_cast<std::size_t>(grains) + 1, 0);  // of all grains before
    for (int i = 0; i < grains; ++i) {
      work[i + 1] += 4;
      for (int k = rows.first(i); k < rows.last(i); ++k) {
        const int j = rows[k].j;
        const int first = is_across(k) ? 0 : 1;
        work[i + 1] += first;
        work[(j < grains ? j : i) + 1] += 2 - first;
      }
    }
    for (int i = 0; i < grains; ++i) work[i + 1] += work[i];
    for (int rank = 1, i = 0; rank < threads; ++rank) {
      while (i < grains && work[i] * threads < work[grains] * rank) ++i;
      bounds_[rank] = i;
    }
  }

  template <class IsAcross>
  void share_crossing(IsAcross is_across) {
    for (Thread& to : threads_) {
      const PairsInOrder& in = to.incoming;
      for (int from = 0, begin = 0; begin < in.count; ++from) {
        int end = begin;
        while (end < in.count && in.first[end] < last(from)) ++end;
        const int half = begin + (end - begin) / 2;
        for (int n = begin; n < end; ++n) {
          const int k = in.pair[n];
          Thread& one = n < half && !is_across(k) ? threads_[from] : to;
          one.crossing.add(in.first[n], in.second[n], k);
        }
        begin = end;
      }
    }
  }
  std::vector<int> bounds_;  // first grain of each block, and the end
  std::vector<Thread> threads_;
};

}  // namespace grainfield::dem
