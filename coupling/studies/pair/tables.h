// What realizations of a pair left, as columns: read from the archived profile, and written as
// tables.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "coupling/run/realization_file.h"
#include "coupling/run/recorded.h"
#include "coupling/studies/pair/closed_forms.h"

namespace grainfield::coupling {

/// The profile of a realization, one row a record. Throws std::invalid_argument naming the file and
/// the column that is missing or broken.
RecordedColumns pair_profile(const Realization& realization, const std::string& file);
/// Its random loops, one row a loop, likewise; empty columns where there are none.
RecordedColumns pair_loops(const Realization& realization, const std::string& file);

/// profiles.csv and loops.csv: the realizations' columns one after the other, with their number.
std::string pair_profiles_csv(const std::vector<RecordedColumns>& realizations);
std::string pair_loops_csv(const std::vector<RecordedColumns>& realizations);

/// An impact, mean over realizations, beside its closed form.
struct PairImpact {
  double speed = 0, angle = 0;  ///< m/s, deg
  bool of_speeds = false, of_angles = false;
  double restitution_normal = 0, restitution_tangential = 0;  ///< the latter nan without slip
  double duration = 0, max_depth = 0, max_force = 0;          ///< s, m, N
  double energy_lost = 0;                                     ///< over the kinetic energy before
  double parted = 0;                                          ///< 1: the bodies came apart
  PairClosedForm closed;
};

/// Those asked for, in the order of dem::pair_launches. `figures`: of every realization, by key.
std::vector<PairImpact> pair_impacts(const dem::PairSetup& setup,
                                     const std::map<std::string, std::vector<double>>& figures);
/// impacts.csv.
std::string pair_impacts_csv(const std::vector<PairImpact>& impacts);

}  // namespace grainfield::coupling
