// Figures of a sample's way there and back, a row each: docs/summary-keys.md says what they are.
#pragma once
#include <string>
#include <vector>

#include "coupling/result/figure.h"
#include "coupling/studies/sample/simulation/setup.h"
#include "coupling/studies/sample/state_table.h"

namespace grainfield::coupling {

/// Share of the imposed strain from which on a sample counts as being in its critical state.
inline constexpr double kCriticalFrom = 0.75;

/// A state bears load while its pressure is above this share of the first one's and its inertial
/// number is below the other: q/p of a liquid is a ratio of two small numbers.
inline constexpr double kLeastPressure = 0.01, kMostInertia = 0.1;

/// A smaller imposed strain loads nothing: the sample is a packing that was filled.
inline constexpr double kLeastLoading = 1e-5;
bool is_loaded(const dem::SamplePlan& plan);

/// What drives the deformation, as columns of the table.
struct Driving {
  std::string stress;        ///< "sigma_xz", "q", "p", "sigma_zz"
  bool compression = false;  ///< its sign is turned round
  std::string meaning;       ///< "shear stress"
};
/// `deformation`: the word of sample.deformation.
Driving driving_of(const std::string& deformation, int dim);

/// By summary key sample.*, a number for each realization that has one. Those of the critical state
/// are left out where it has too few states, or one that bears no load; of a packing that is not
/// loaded those of the loading are.
FigureSamples sample_samples(const StateTable& table, const dem::SamplePlan& plan);

/// Their declarations.
std::vector<SummaryKey> sample_figures();

}  // namespace grainfield::coupling
