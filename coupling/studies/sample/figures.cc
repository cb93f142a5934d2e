#include "coupling/studies/sample/keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> sample_figures() {
  return {
      {"sample.initial_pressure", "N/m (3D: Pa)", "p of a sample at rest, before it is deformed"},
      {"sample.initial_solid_fraction", "-", "its solid fraction then; overlaps count twice"},
      {"sample.initial_coordination", "-", "contacts of a grain then, without rattlers"},
      {"sample.gap_spheres", "-", "dropped: spheres that fill the gap below the lid"},
      {"sample.dropped_solid_fraction", "-",
       "dropped: solid fraction as the lid has been put on and the gap filled"},
      {"sample.final_pressure", "N/m (3D: Pa)", "p of the last state of the loading"},
      {"sample.lost_strength", "-",
       "share of the samples that lose their strength: some state has less than 1 % of the first "
       "pressure, or an inertial number above 0.1"},
      {"sample.strain_at_loss", "-", "imposed strain of the first such state, of these samples"},
      {"sample.lateral_stress_ratio", "-",
       "uniaxial: lateral over axial stress of the last state of the loading, K0"},
      {"sample.peak_stress_ratio", "-",
       "largest q/p of the recorded states (states.csv) that bear load (sample.lost_strength)"},
      {"sample.strain_at_peak", "-", "imposed strain of that state"},
      {"sample.peak_friction_angle_deg", "deg", "mobilised friction angle of that state"},
      {"sample.critical_stress_ratio", "-", "mean q/p of the states in the last quarter of strain"},
      {"sample.critical_friction_angle_deg", "deg", "mobilised friction angle, likewise"},
      {"sample.critical_solid_fraction", "-", "solid fraction, likewise"},
      {"sample.critical_coordination", "-", "contacts of a grain without rattlers, likewise"},
      {"sample.critical_drift", "-",
       "mean q/p of the second half of these states over that of the first, less 1: near 0 where "
       "the critical state is reached"},
      {"sample.secant_modulus", "N/m (3D: Pa)",
       "rise of the driving stress over strain, to half of its largest rise: shear stress (simple "
       "shear), q (axial), axial pressure (uniaxial), p (isotropic)"},
      {"sample.secant_strain", "-", "imposed strain there"},
      {"sample.volumetric_strain", "-", "ln(V/V0) of the last state, dilation positive"},
      {"sample.inertial_number", "-",
       "largest rate d sqrt(rho/p) of the states: below 1e-3 quasi-static"},
      {"sample.stress_error", "-",
       "largest relative error of a servo's stress at any of its measurements in the deformation"},
      {"sample.stress_rms_error", "-", "root of the mean square of the same"},
      {"sample.kinetic_share", "-",
       "largest kinetic over elastic energy of the states after the first one"},
      {"sample.late_kinetic_share", "-",
       "the same of the states of the loading beyond a tenth of its strain"},
      {"sample.late_inertial_number", "-", "largest inertial number of the same states"},
      {"sample.pressure_ratio", "-", "p at the end of the loading over that of the first state"},
      {"sample.shear_over_pressure", "-",
       "simple shear: shear stress at the end of the loading over p of the first state"},
      {"sample.first_shear_stiffness", "-",
       "simple shear at constant volume: rise of the shear stress to the state after the first "
       "one, "
       "over its strain and over p of the first state"},
      {"sample.axial_dip_strain", "-",
       "simple shear at constant volume: shear strain (half the shear) of the recorded state of "
       "the "
       "loading whose axial pressure is least; it falls first and rises then"},
      {"sample.end_stress_ratio", "-", "uniaxial: q/p at the end of the loading"},
      {"sample.end_axial_stress_ratio", "-",
       "uniaxial in three dimensions: q/p there with q the axial pressure less the mean lateral "
       "one "
       "(Wellmann 32), as axial_q_over_p of states.csv"},
      {"sample.stiffening", "-",
       "uniaxial: rise of the axial stress in the second half of the strain over that in the first "
       "half; 1 of a straight line"},
      {"sample.stiffening_late", "-", "the same of the last quarter over the second one"},
      {"sample.plastic_strain", "-",
       "unloading: strain where the axial stress (of the lid; in a cell of the contacts) is that "
       "of "
       "the first state again, or a thousandth of the largest where the first one is below it"},
      {"sample.unloading_stiffness", "-",
       "its slope to the middle state of the unloading over that of the loading's last quarter"},
      {"sample.loop_loss", "-", "area of its loop over that under the loading"},
      {"sample.residual_stress", "-",
       "axial stress of the contacts after the unloading over that at the end of the loading"},
      {"sample.energy_balance_error", "-",
       "largest change of the energies' sum less the work, over the work, of the states"},
  };
}

}  // namespace grainfield::coupling
