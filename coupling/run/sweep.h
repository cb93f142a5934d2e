// The members of a sweep side by side: one summary, one report.
#pragma once
#include <string>
#include <vector>

#include "coupling/run/study_result.h"

namespace grainfield::coupling {

/// Writes summary.json (every member's keys with ".SUFFIX" at the end), report.html and case.toml
/// of a sweep whose members' outputs are in folder/SUFFIX. Returns what the report lacks
/// (ReportResult::complaint).
std::string write_sweep(const std::string& folder, const Case& value,
                        const std::vector<SweepCase>& members,
                        const std::vector<StudyResult>& results);

/// The members' profiles, a frame each and a curve per member. Members differ in depth by a little:
/// the profiles are the same by number. Each is drawn in its own units, as loads and heights may be
/// what is swept.
Picture member_profiles(const Case& value, const std::vector<SweepCase>& members,
                        const std::vector<StudyResult>& results);

}  // namespace grainfield::coupling
