// The closed-form models as the registry lists them.
#pragma once
#include "continuum/model.h"

namespace grainfield::continuum {

ModelInfo flamant_info();
ModelInfo boussinesq_info();
ModelInfo transverse_half_space_info();
ModelInfo transverse_layer_info();
ModelInfo layer_info();
ModelInfo hydrostatic_info();
ModelInfo liffman_info();
ModelInfo cantelaube_info();
ModelInfo cantelaube_asymmetric_info();
ModelInfo osl_info();
ModelInfo fpa_info();
ModelInfo bcc_info();
ModelInfo ife_info();
ModelInfo cone_osl_info();
ModelInfo cone_fpa_info();
ModelInfo cone_fpa_levy_info();
ModelInfo cone_bcc_info();
ModelInfo osl_layer_info();
ModelInfo orthotropic_half_plane_info();
ModelInfo orthotropic_layer_info();

/// Range of sizes, weights and loads of heaps and OSL layers: squares of rho g h^2 stay finite.
inline constexpr double kLeastScale = 1e-50, kMostScale = 1e50;

/// Parameters that all heaps share: phi_deg (friction angle and, unless the model has slopes of its
/// own, slope) and rho_g.
Parameter friction_angle();
Parameter weight();

}  // namespace grainfield::continuum
