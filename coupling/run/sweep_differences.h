// Whether the members of a sweep differ by more than their realizations do among themselves.
#pragma once
#include <string>
#include <vector>

#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// A figure of one member against the same of the first.
struct SweepDifference {
  std::string heading, key;  ///< of the figure
  std::size_t member = 0;    ///< 1 or more
  double difference = 0;     ///< member - first, in the figure's unit
  double error = 0;          ///< its standard error
  double p_value = 0;        ///< two-sided, Welch's t over realizations
  double p_holm = 0;         ///< the same, corrected by Holm for all that are compared
};

/// Differences in columns with a standard error over `least_for_significance` realizations in
/// both members; members are taken as independent, which is on the safe side where the same seeds
/// make them alike.
std::vector<SweepDifference> sweep_differences(const std::vector<OverviewColumn>& columns,
                                               const std::vector<Summary>& members);

/// Two-sided p of a difference d of two means of standard errors s1, s2 over n1, n2 values
/// (Welch 1947); nan without errors or below least_for_significance values.
double welch_p_value(double d, double s1, int n1, double s2, int n2);

/// One sentence: what differs at 5 % after Holm's correction, or that nothing does. `names` are the
/// members'. Empty when nothing could be compared.
std::string differences_sentence(const std::vector<SweepDifference>& differences,
                                 const std::vector<std::string>& names);

}  // namespace grainfield::coupling
