// The rows of profiles.csv as columns: what the file holds and what Python takes.
#pragma once
#include <string>
#include <vector>

#include "coupling/compare/compare.h"

namespace grainfield::coupling {

struct ProfileColumn {
  std::string name, unit;  ///< unit "1": a pure number
  std::vector<double> values;
};

struct ProfileColumns {
  std::vector<std::string> notes;    ///< the scale, what the values are
  std::vector<std::string> profile;  ///< of each row
  std::vector<ProfileColumn> columns;
};

/// A row for each point of the profiles, then of those `beside`, which have no models (nan). The
/// columns: depth and x, m; mean, its standard error (nan without one), and of each model its
/// value, difference (mean - model) and difference over error, in the profiles' unit.
ProfileColumns profile_columns(const Comparison& comparison);

/// "F = 300 N, h = 0.15 m, ...": how the profiles are made dimensionless.
std::string scale_note(const Comparison& comparison);

}  // namespace grainfield::coupling
