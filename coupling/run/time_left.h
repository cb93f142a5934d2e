// How long an ensemble still takes, from how fast its tasks came forward.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace grainfield::coupling {

/// Tasks of one kind need about the same time for the same part of their work: a part takes what it
/// took the tasks that have done it. A part that is known of less than one whole task takes what
/// the others took on average, or in the last third of the time where that was slower. A kind of
/// which nothing is done yet counts as all the others together.
class TimeLeft {
 public:
  /// The kind of each task.
  explicit TimeLeft(const std::vector<std::size_t>& kinds);

  /// At `seconds` since the start this task has done this fraction; less than before is no news.
  void tell(std::size_t task, double seconds, double fraction);
  /// s until `mine` are done, so many at a time; negative: not known yet.
  double left(const std::vector<std::size_t>& mine, int workers) const;

 private:
  static constexpr std::size_t kParts = 200;
  struct Reached {
    bool begun = false;
    double seconds = 0, fraction = 0;
    std::size_t kind = 0;
  };
  using Parts = std::array<double, kParts>;
  struct Passed {
    Parts took{}, done{};  // s, and parts' shares: sums over tasks
  };

  Passed all_kinds() const;
  static Parts paces(const Passed& passed);

  std::vector<Reached> tasks_;
  std::vector<Passed> passed_;  // by kind
};

}  // namespace grainfield::coupling
