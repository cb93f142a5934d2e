// The short steps of Newton's that a pair in contact takes (common_normal.h), for both bodies side
// by side.
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
enum class Stepped {
  settled,  ///< the contact is found, and remembered
  apart,    ///< the remembered normal proves it
  neither   ///< more has to be done than a few short steps
};

/// From the remembered normal by at most kMostSteps. The bits do not depend on the processor.
Stepped step_pair(PairStep pair, bool curvatures);

}  // namespace grainfield::dem
