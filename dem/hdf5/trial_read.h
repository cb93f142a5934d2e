// HDF5 can crash on a damaged file. So a child process reads a file first.
#pragma once
#include <stdexcept>
#include <string>

namespace grainfield::dem::hdf5 {

/// Reads all of the file in a child process whose time and memory are bounded; once per process
/// and state of the file. Throws std::invalid_argument naming the file when the child does not
/// come to its end; CannotReadNow when somebody else ends the child, or the process may not take
/// the memory. Like all calls of HDF5 by one thread at a time.
void read_on_trial(const std::string& file);
/// This process has written the file as it is now: it needs no look.
void trust(const std::string& file);

/// The structure of a file is more than a quick look can take in: nothing is known of its state.
class TooMuchToLookAt : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// While it lives, read_on_trial() goes through groups and attributes only, within 2 s and 64 MB
/// whatever the file's size, and throws TooMuchToLookAt where that is not enough: for who asks what
/// is in a file and reads no data.
class StructureOnly {
 public:
  StructureOnly() { ++depth_; }
  ~StructureOnly() { --depth_; }
  StructureOnly(const StructureOnly&) = delete;
  StructureOnly& operator=(const StructureOnly&) = delete;
  static bool holds() { return depth_ > 0; }

 private:
  static int depth_;
};

/// Bytes of all datasets in memory, as the file claims, by a look as under StructureOnly. Throws as
/// open_for_reading, and TooMuchToLookAt.
double content_bytes(const std::string& file);

}  // namespace grainfield::dem::hdf5
