// Measured forces on the ground beside those of a pile of grains, as Liffman's figure 17 has them:
// places over the base, forces over the largest one.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/case/study.h"
#include "coupling/report/picture.h"
#include "coupling/result/tables.h"

namespace grainfield::coupling {

/// [measured]
struct MeasuredSetup {
  std::string field;          ///< file of `grainfield import-field`; empty: none
  std::string name = "base";  ///< of the field in it
};

void declare_measured_keys(SectionKeys s);
inline constexpr KeySection kMeasuredKeys{"measured", KeyRole::analysis, declare_measured_keys};
/// Keys "measured.*" of summary.json.
std::vector<SummaryKey> measured_figures();

/// Forces or stresses along a base; x over its width, 0 in the middle of it.
struct BaseProfile {
  Eigen::VectorXd x, normal, shear;           ///< normal: down; shear: to the right, on the ground
  Eigen::VectorXd normal_error, shear_error;  ///< standard errors; nan or empty: unknown
  double height = 1;                          ///< of the heap, over its base

  /// The same over the largest normal and the largest shear.
  BaseProfile normalized() const;
};

/// The base of a heap as measured. Throws std::invalid_argument beginning with measured.field or
/// measured.name: no such file or field, no heap, no pressures and shears, fewer than five places
/// on the base.
BaseProfile measured_base(const MeasuredSetup& setup);

/// The shear in the middle, where it is straight in the line model: before the model's bend, within
/// 1/4 of the base, and five places or more. Its slope, over the largest shear and per base, and
/// the share of its variance that the line explains.
struct MiddleShear {
  double slope = 0, explained = 0;
};
MiddleShear middle_shear(const BaseProfile& base);
/// Mean normal force within 1/20 of the base of its middle over the largest one.
double centre_over_largest(const BaseProfile& base);

/// Adds the figures of both, normalized, and gives the picture of them; `grains` runs along x.
Chart beside_measured(const BaseProfile& grains, const BaseProfile& measured, Summary& summary);

}  // namespace grainfield::coupling
