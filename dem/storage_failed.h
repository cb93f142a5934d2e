// What the storage refuses.
#pragma once
#include <stdexcept>

namespace grainfield::dem {

/// An output cannot be written to its end: the disk is full, the file too large, the device
/// failed. The message names the file. Exit code 74.
class StorageFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace grainfield::dem
