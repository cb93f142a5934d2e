// What a computation throws that cannot go on.
#pragma once
#include <stdexcept>

namespace grainfield {

/// A simulation or a model that failed (diverged, not converged, never came to rest, no
/// equilibrium): says when, where and what to change.
class ComputationFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace grainfield
