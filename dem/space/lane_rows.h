// Rows of numbers in memory, one for each lane, as columns of lanes, and back (lanes.h).
#pragma once
#include "dem/space/lanes.h"

namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS {

/// Four columns.
template <int W>
struct Four {
  Lanes<W> a, b, c, d;
};

namespace lane_rows {

// Blocks of four rows by four columns, turned; of eight lanes two blocks side by side, rows 0 to 3
// and 4 to 7. Its own inverse.
template <int W>
[[gnu::always_inline]] inline Four<W> turned_about(const Four<W>& x) {
  if constexpr (W == 4) {
    const auto t0 = __builtin_shufflevector(x.a, x.b, 0, 4, 2, 6);
    const auto t1 = __builtin_shufflevector(x.a, x.b, 1, 5, 3, 7);
    const auto t2 = __builtin_shufflevector(x.c, x.d, 0, 4, 2, 6);
    const auto t3 = __builtin_shufflevector(x.c, x.d, 1, 5, 3, 7);
    return {
        __builtin_shufflevector(t0, t2, 0, 1, 4, 5), __builtin_shufflevector(t1, t3, 0, 1, 4, 5),
        __builtin_shufflevector(t0, t2, 2, 3, 6, 7), __builtin_shufflevector(t1, t3, 2, 3, 6, 7)};
  } else {
    const auto t0 = __builtin_shufflevector(x.a, x.b, 0, 8, 2, 10, 4, 12, 6, 14);
    const auto t1 = __builtin_shufflevector(x.a, x.b, 1, 9, 3, 11, 5, 13, 7, 15);
    const auto t2 = __builtin_shufflevector(x.c, x.d, 0, 8, 2, 10, 4, 12, 6, 14);
    const auto t3 = __builtin_shufflevector(x.c, x.d, 1, 9, 3, 11, 5, 13, 7, 15);
    return {__builtin_shufflevector(t0, t2, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(t1, t3, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(t0, t2, 2, 3, 10, 11, 6, 7, 14, 15),
            __builtin_shufflevector(t1, t3, 2, 3, 10, 11, 6, 7, 14, 15)};
  }
}
template <class Row>
[[gnu::always_inline]] inline Lanes<8> two_rows(Row* const* rows, int k, int at) {
  return __builtin_shufflevector(loaded<4>(rows[k] + at), loaded<4>(rows[k + 4] + at), 0, 1, 2, 3,
                                 4, 5, 6, 7);
}

}  // namespace lane_rows

/// Numbers at to at + 3 of each row.
template <int W, class Row>
[[gnu::always_inline]] inline Four<W> four_of(Row* const* rows, int at) {
  using namespace lane_rows;
  if constexpr (W == 2) {
    const auto a = loaded<2>(rows[0] + at), b = loaded<2>(rows[1] + at);
    const auto c = loaded<2>(rows[0] + at + 2), d = loaded<2>(rows[1] + at + 2);
    return {__builtin_shufflevector(a, b, 0, 2), __builtin_shufflevector(a, b, 1, 3),
            __builtin_shufflevector(c, d, 0, 2), __builtin_shufflevector(c, d, 1, 3)};
  } else if constexpr (W == 4) {
    return turned_about<4>({loaded<4>(rows[0] + at), loaded<4>(rows[1] + at),
                            loaded<4>(rows[2] + at), loaded<4>(rows[3] + at)});
  } else {
    return turned_about<8>({two_rows(rows, 0, at), two_rows(rows, 1, at), two_rows(rows, 2, at),
                            two_rows(rows, 3, at)});
  }
}

/// The rows of four columns: visit(k, row of lane k), one lane after the other.
template <int W, class Visit>
[[gnu::always_inline]] inline void each_row(const Four<W>& columns, Visit visit) {
  const auto join = [](const Lanes<2>& first, const Lanes<2>& second) {
    return __builtin_shufflevector(first, second, 0, 1, 2, 3);
  };
  if constexpr (W == 2) {
    visit(0, join(__builtin_shufflevector(columns.a, columns.b, 0, 2),
                  __builtin_shufflevector(columns.c, columns.d, 0, 2)));
    visit(1, join(__builtin_shufflevector(columns.a, columns.b, 1, 3),
                  __builtin_shufflevector(columns.c, columns.d, 1, 3)));
  } else {
    const Four<W> rows = lane_rows::turned_about<W>(columns);
    const auto first = [](const Lanes<W>& x) { return __builtin_shufflevector(x, x, 0, 1, 2, 3); };
    visit(0, first(rows.a));
    visit(1, first(rows.b));
    visit(2, first(rows.c));
    visit(3, first(rows.d));
    if constexpr (W == 8) {
      const auto second = [](const Lanes<8>& x) {
        return __builtin_shufflevector(x, x, 4, 5, 6, 7);
      };
      visit(4, second(rows.a));
      visit(5, second(rows.b));
      visit(6, second(rows.c));
      visit(7, second(rows.d));
    }
  }
}
/// The same of six columns of eight lanes: rows of eight numbers, the last two 0.
template <class Visit>
[[gnu::always_inline]] inline void each_row_of_six(const Four<8>& four, const Lanes<8>& e,
                                                   const Lanes<8>& f, Visit visit) {
  const Lanes<8> none{};
  // Pairs of numbers of rows 0, 2, 4, 6 and of rows 1, 3, 5, 7; then four rows' of each side by
  // side.
  const auto side_by_side = [&](const Lanes<8>& ab, const Lanes<8>& cd, const Lanes<8>& ef,
                                int at) {
    const auto low = __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 2, 3, 10, 11);
    const auto high = __builtin_shufflevector(ab, cd, 4, 5, 12, 13, 6, 7, 14, 15);
    const auto last_low = __builtin_shufflevector(ef, none, 0, 1, 8, 9, 2, 3, 8, 9);
    const auto last_high = __builtin_shufflevector(ef, none, 4, 5, 8, 9, 6, 7, 8, 9);
    visit(at, __builtin_shufflevector(low, last_low, 0, 1, 2, 3, 8, 9, 10, 11));
    visit(at + 2, __builtin_shufflevector(low, last_low, 4, 5, 6, 7, 12, 13, 14, 15));
    visit(at + 4, __builtin_shufflevector(high, last_high, 0, 1, 2, 3, 8, 9, 10, 11));
    visit(at + 6, __builtin_shufflevector(high, last_high, 4, 5, 6, 7, 12, 13, 14, 15));
  };
  const auto even = [](const Lanes<8>& x, const Lanes<8>& y) {
    return __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
  };
  const auto odd = [](const Lanes<8>& x, const Lanes<8>& y) {
    return __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
  };
  side_by_side(even(four.a, four.b), even(four.c, four.d), even(e, f), 0);
  side_by_side(odd(four.a, four.b), odd(four.c, four.d), odd(e, f), 1);
}
/// The same of two columns.
template <int W, class Visit>
[[gnu::always_inline]] inline void each_pair(const Lanes<W>& a, const Lanes<W>& b, Visit visit) {
  if constexpr (W == 2) {
    visit(0, __builtin_shufflevector(a, b, 0, 2));
    visit(1, __builtin_shufflevector(a, b, 1, 3));
  } else if constexpr (W == 4) {
    const auto even = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    const auto odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    visit(0, __builtin_shufflevector(even, even, 0, 1));
    visit(1, __builtin_shufflevector(odd, odd, 0, 1));
    visit(2, __builtin_shufflevector(even, even, 2, 3));
    visit(3, __builtin_shufflevector(odd, odd, 2, 3));
  } else {
    const auto even = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    const auto odd = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    visit(0, __builtin_shufflevector(even, even, 0, 1));
    visit(1, __builtin_shufflevector(odd, odd, 0, 1));
    visit(2, __builtin_shufflevector(even, even, 2, 3));
    visit(3, __builtin_shufflevector(odd, odd, 2, 3));
    visit(4, __builtin_shufflevector(even, even, 4, 5));
    visit(5, __builtin_shufflevector(odd, odd, 4, 5));
    visit(6, __builtin_shufflevector(even, even, 6, 7));
    visit(7, __builtin_shufflevector(odd, odd, 6, 7));
  }
}

}  // namespace grainfield::dem::inline GRAINFIELD_INSTRUCTIONS
