// Strain between two states of one packing, from their files.
#pragma once
#include <Eigen/Core>
#include <string>

#include "coupling/base/field.h"
#include "coupling/strain/strain.h"
#include "coupling/tasks/average_task.h"

namespace grainfield::coupling {

struct StrainRequest {
  SnapshotName before, after;
  StrainOptions options;        ///< width 0: three mean diameters
  std::string frame = "layer";  ///< as AverageRequest::frame; heights and apex are those before,
  std::string up;               ///< as AverageRequest::up
                                ///< the load that of either state
  Eigen::MatrixXd points;       ///< in the frame; or empty
  /// Grid over the packing, where points are empty; nz in space. 0: 81 x 31, in space 21 x 21 x 21.
  int nx = 0, ny = 0, nz = 0;
};

struct StrainOutcome {
  Field field;         ///< StrainResult::field on the frame's points, with measure, width and frame
  std::string report;  ///< StrainResult::report()
  std::string images;  ///< what was done where a state has no images of a periodic cell; or empty
  std::string doubt;   ///< not empty: displacements may be those of images
};

/// What a user gave of it, checked and completed, before run_strain(): the support of the measure
/// where none was chosen, a width above 0 where one was. Throws std::invalid_argument naming the
/// option.
void settle(StrainRequest& request, bool support_chosen, bool width_chosen);

/// Throws std::invalid_argument as strain() and place().
StrainOutcome run_strain(const StrainRequest& request);

}  // namespace grainfield::coupling
