#include "coupling/run/time_left.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainfield::coupling {
namespace {

// Done of a task before anything is told.
constexpr double kLeast = 0.01;
// Of the time so far: what came last tells of what comes next. Fewer parts may hold a standstill.
constexpr double kRecent = 1.0 / 3, kFewest = 5;
// A part that is done, but for rounding.
constexpr double kWhole = 1 - 1e-9;

// Calls take(k, share) with the share of each of `parts` equal parts that is between two fractions.
template <class Take>
void for_parts(std::size_t parts, double from, double to, Take take) {
  const auto n = static_cast<double>(parts);
  for (auto k = static_cast<std::size_t>(from * n); k < parts && static_cast<double>(k) < to * n;
       ++k) {
    const auto begin = static_cast<double>(k);
    const double share = std::min(to * n, begin + 1) - std::max(from * n, begin);
    if (share > 0) take(k, share);
  }
}

double total_of(const auto& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

void TimeLeft::tell(std::size_t task, double seconds, double fraction) {
  Reached& last = tasks_[task];
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (!last.begun) {
    last = {true, seconds, fraction};
    return;
  }
  if (!(fraction > last.fraction)) return;
  const double each = (seconds - last.seconds) / ((fraction - last.fraction) * kParts);
  for_parts(kParts, last.fraction, fraction, [&](std::size_t k, double share) {
    took_[k] += share * each;
    done_[k] += share;
  });
  last = {true, seconds, fraction};
}

// s that each part takes. One that no task has passed from end to end counts as unknown: after a
// standstill its first bit would make it last for hours.
std::array<double, TimeLeft::kParts> TimeLeft::paces() const {
  const double all = total_of(took_);
  double took = 0, done = 0;
  for (std::size_t k = kParts; k-- > 0 && (took < kRecent * all || done < kFewest);) {
    took += took_[k];
    done += done_[k];
  }
  const double unknown = std::max(all / total_of(done_), took / done);
  std::array<double, kParts> out{};
  for (std::size_t k = 0; k < kParts; ++k)
    out[k] = done_[k] >= kWhole ? took_[k] / done_[k] : unknown;
  return out;
}

double TimeLeft::left(const std::vector<std::size_t>& mine, int workers) const {
  if (total_of(done_) <= kLeast * kParts * static_cast<double>(mine.size())) return -1;
  const auto pace = paces();
  double all = 0, longest = 0;
  for (const std::size_t task : mine) {
    double one = 0;
    for_parts(kParts, tasks_[task].fraction, 1,
              [&](std::size_t k, double share) { one += share * pace[k]; });
    all += one;
    longest = std::max(longest, one);
  }
  return std::max(all / workers, longest);
}

}  // namespace grainfield::coupling
