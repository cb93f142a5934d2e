#include "coupling/run/time_left.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainfield::coupling {
namespace {

// No estimate before this share of a task is done.
constexpr double kLeast = 0.01;
// Share of the time so far that tells of what comes next, and the least number of parts: fewer may
// hold a standstill.
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

TimeLeft::TimeLeft(const std::vector<std::size_t>& kinds) : tasks_(kinds.size()) {
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    tasks_[k].kind = kinds[k];
    passed_.resize(std::max(passed_.size(), kinds[k] + 1));
  }
}

void TimeLeft::tell(std::size_t task, double seconds, double fraction) {
  Reached& last = tasks_[task];
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (!last.begun) {
    last = {true, seconds, fraction, last.kind};
    return;
  }
  if (!(fraction > last.fraction)) return;
  const double each = (seconds - last.seconds) / ((fraction - last.fraction) * kParts);
  Passed& passed = passed_[last.kind];
  for_parts(kParts, last.fraction, fraction, [&](std::size_t k, double share) {
    passed.took[k] += share * each;
    passed.done[k] += share;
  });
  last.seconds = seconds;
  last.fraction = fraction;
}

TimeLeft::Passed TimeLeft::all_kinds() const {
  Passed out;
  for (const Passed& one : passed_) {
    for (std::size_t k = 0; k < kParts; ++k) {
      out.took[k] += one.took[k];
      out.done[k] += one.done[k];
    }
  }
  return out;
}

// s that each part takes. After a standstill the first bit of a part would make it last for hours.
TimeLeft::Parts TimeLeft::paces(const Passed& passed) {
  const double all = total_of(passed.took);
  double took = 0, done = 0;
  for (std::size_t k = kParts; k-- > 0 && (took < kRecent * all || done < kFewest);) {
    took += passed.took[k];
    done += passed.done[k];
  }
  const double unknown = std::max(all / total_of(passed.done), done > 0 ? took / done : 0.0);
  Parts out{};
  for (std::size_t k = 0; k < kParts; ++k) {
    out[k] = passed.done[k] >= kWhole ? passed.took[k] / passed.done[k] : unknown;
  }
  return out;
}

double TimeLeft::left(const std::vector<std::size_t>& mine, int workers) const {
  const Passed any = all_kinds();
  if (total_of(any.done) <= kLeast * kParts * static_cast<double>(mine.size())) return -1;
  std::vector<Parts> pace;
  for (const Passed& one : passed_) pace.push_back(paces(total_of(one.done) > 0 ? one : any));
  double all = 0, longest = 0;
  for (const std::size_t task : mine) {
    double one = 0;
    for_parts(kParts, tasks_[task].fraction, 1,
              [&](std::size_t k, double share) { one += share * pace[tasks_[task].kind][k]; });
    all += one;
    longest = std::max(longest, one);
  }
  return std::max(all / workers, longest);
}

}  // namespace grainfield::coupling
