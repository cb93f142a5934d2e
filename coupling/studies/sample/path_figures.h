// Figures of a sample's way there and back, one for each realization.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "coupling/studies/sample/state_table.h"
#include "dem/study/sample_setup.h"

namespace grainfield::coupling {

/// By summary key, a number for each realization:
///   sample.kinetic_share         largest kinetic over elastic energy of the states after the first
///   sample.pressure_ratio        p at the end of the loading over that at the start
/// of simple shear
///   sample.shear_over_pressure   shear stress at the end of the loading over p at the start
///   sample.axial_dip_strain      at constant volume: half the shear of the state of the loading
///                                whose axial pressure is least
/// of uniaxial deformation
///   sample.end_stress_ratio      q/p at the end of the loading
///   sample.end_axial_stress_ratio  the same with the source's q, in three dimensions
///   sample.stiffening            rise of the axial stress in the second half of the strain over
///                                that in the first half: 1 of a straight line
///   sample.stiffening_late       the same of the last quarter over the second one
/// of an unloading, with the axial stress of the lid or, in a cell, of the contacts
///   sample.plastic_strain        strain where that of the first state is met again
///   sample.unloading_stiffness   slope to the middle state of the unloading over that of the
///                                last quarter of the loading
///   sample.loop_loss             area of the loop over that under the loading
///   sample.residual_stress       axial stress of the contacts at the end over the largest
std::map<std::string, std::vector<double>> path_figures(const StateTable& table,
                                                        const dem::SamplePlan& plan);

}  // namespace grainfield::coupling
