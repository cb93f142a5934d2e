// One of Newton's steps for pairs in contact (common_normal.h), for several pairs at a time.
#pragma once
#include "dem/shapes/common_normal.h"

namespace grainfield::dem {

/// A pair that touched in the step before.
struct PairStep {
  const TurnedBody* i = nullptr;
  const TurnedBody* j = nullptr;
  Eigen::Vector3d across = Eigen::Vector3d::Zero();  ///< D, m
  PairNormal* memory = nullptr;                      ///< its powers are carried on
  CommonNormal* out = nullptr;
};

/// Steps from the remembered normals. A pair is settled when that is all it takes; when it is not,
/// the bodies may be apart, or more steps are needed. The bits of a pair do not depend on the
/// others nor on the processor.
void step_pairs(PairStep* pairs, int count, bool curvatures);

}  // namespace grainfield::dem
