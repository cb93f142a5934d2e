// Mohr-Coulomb strength and dilation of a sample on its way (docs/theory-dem.md).
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/case/study.h"
#include "coupling/studies/sample/simulation/setup.h"
#include "coupling/studies/sample/state_table.h"

namespace grainfield::coupling {

/// How friction and dilation show: between principal stresses (sin phi = (s1 - s3)/(s1 + s3)), or
/// on the planes that slide (tan phi = tau/sigma).
enum class StrengthTest { axial, shear };

/// The loading of one realization, state by state. Stresses in any one unit, compression positive.
struct StrengthPath {
  StrengthTest test = StrengthTest::axial;
  Eigen::VectorXd strain;      ///< axial: shortening; shear: tangent. Logarithms where small
  Eigen::VectorXd volumetric;  ///< dilation positive; empty: the volume is held
  Eigen::VectorXd driving;     ///< s1, or tau
  Eigen::VectorXd holding;     ///< s3 (mean of the lateral ones), or sigma across the planes
  std::vector<bool> bears;     ///< the state bears load
};

/// Angles, degrees; nan where the path does not tell them.
struct Strength {
  double peak_friction = 0, residual_friction = 0, strain_at_peak = 0;
  double peak_dilation = 0, dilation_at_peak = 0, residual_dilation = 0;
};

/// Peak: of the states; residual: mean over the last quarter of the strain (kCriticalFrom), where
/// all its states bear load. Dilation angles are slopes, by least squares over windows of about a
/// fifth of the states: x = d volumetric / d strain gives sin psi = x/(2 + x) (axial; triaxial and
/// plane alike) and tan psi = x (shear): its largest, about the peak of friction (at the very peak
/// where rates hold, Rowe), and over the last quarter.
Strength strength_of(const StrengthPath& path);

/// Paths of all realizations; empty for deformations that show no strength.
std::vector<StrengthPath> strength_paths(const StateTable& table, const dem::SamplePlan& plan);

/// By summary key strength.*, a number for each realization; keys that are not known for all of
/// them are left out.
FigureSamples strength_figures(const std::vector<StrengthPath>& paths);

std::vector<SummaryKey> strength_summary_keys();

}  // namespace grainfield::coupling
