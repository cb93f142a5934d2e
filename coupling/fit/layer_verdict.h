// The verdict in words: which model; of layers under a point load also elliptic or hyperbolic.
#pragma once
#include <string>
#include <vector>

#include "coupling/fit/fit.h"
#include "coupling/fit/selection.h"

namespace grainfield::coupling {

/// Of heaps `model` is the first of the ranking, and nothing is said of equations and agreement.
struct FitVerdict {
  /// The supported model with the fewest free numbers (the best among equals): richer models of
  /// which it is a special case cannot be told from it and do not outbid it.
  std::string model;
  bool alone = false;     ///< every supported model contains it as a special case
  std::string equations;  ///< "elliptic", "hyperbolic", "not distinguishable"
  bool agrees = false;    ///< its chi2/dof is what chance allows
  std::string sentence;   ///< for people, with the evidence
};

/// Whether `special` is a special case of the layer model `general`, or the same: what they are
/// called says nothing of it.
bool contains(const Fit& general, const Fit& special);

/// `fits` and `selection` of the same data and models. Below 3 realizations nothing is
/// distinguishable: `model` is then the nearest by relative L2.
FitVerdict layer_verdict(const std::vector<Fit>& fits, const Selection& selection,
                         int realizations);

}  // namespace grainfield::coupling
