#include "coupling/studies/sample/keys.h"

namespace grainfield::coupling {

std::vector<SummaryKey> sample_figures() {
  return {
      {"sample.initial_pressure", "N/m (3D: Pa)", "p of a sample at rest, before it is deformed"},
      {"sample.initial_solid_fraction", "-", "its solid fraction then; overlaps count twice"},
      {"sample.initial_coordination", "-", "contacts of a grain then, without rattlers"},
      {"sample.final_pressure", "N/m (3D: Pa)", "p of the last state"},
      {"sample.lost_strength", "-",
       "share of the samples that lose their strength: some state has less than 1 % of the first "
       "pressure, or an inertial number above 0.1"},
      {"sample.strain_at_loss", "-", "imposed strain of the first such state, of these samples"},
      {"sample.lateral_stress_ratio", "-",
       "uniaxial: lateral over axial stress of the last state, K0"},
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
      {"sample.energy_balance_error", "-",
       "largest change of the energies' sum less the work, over the work, of the states"},
  };
}

}  // namespace grainfield::coupling
