// Figures of a sample's curves, one for each realization.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "coupling/studies/sample/state_table.h"

namespace grainfield::coupling {

/// Share of the imposed strain from which on a sample counts as being in its critical state.
inline constexpr double kCriticalFrom = 0.75;

/// A state bears load while its pressure is above this share of the first one's and its inertial
/// number is below the other: q/p of a liquid is a ratio of two small numbers.
inline constexpr double kLeastPressure = 0.01, kMostInertia = 0.1;

/// What drives the deformation, as columns of the table.
struct Driving {
  std::string stress;        ///< "sigma_xz", "q", "p", "sigma_zz"
  bool compression = false;  ///< its sign is turned round
  std::string meaning;       ///< "shear stress"
};
/// `deformation`: the word of sample.deformation.
Driving driving_of(const std::string& deformation, int dim);

/// By summary key, a number for each realization, of the states up to `records`, the last one of
/// the loading: of the first state
///   sample.initial_{pressure,solid_fraction,coordination}
/// and of the curves
///   sample.final_pressure                        of the last state
///   sample.lost_strength                         1: some state bears no load any more, else 0
///   sample.strain_at_loss                        of the first such state
/// of simple shear and axial deformation, of states that bear load (bears()):
///   sample.peak_stress_ratio, .strain_at_peak    the largest q/p of the states
///   sample.critical_*                            means over the states from kCriticalFrom on
///   sample.critical_drift                        q/p of their second half over the first, less 1
/// of uniaxial deformation
///   sample.lateral_stress_ratio                  of the last state, K0
/// and of all
///   sample.volumetric_strain                     of the last state
///   sample.secant_modulus, .secant_strain        to half of the largest rise of the driving stress
///   sample.energy_balance_error                  the largest of the states; where it was followed
/// Those of the critical state are left out where it has too few states, or one that bears no load.
std::map<std::string, std::vector<double>> state_figures(const StateTable& table,
                                                         const std::string& deformation,
                                                         int records);

}  // namespace grainfield::coupling
