// What a simulation throws that cannot go on.
#pragma once
#include <stdexcept>

namespace grainfield::dem {

/// A simulation that failed (diverged, never came to rest): says when, where and what to change.
class ComputationFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace grainfield::dem
