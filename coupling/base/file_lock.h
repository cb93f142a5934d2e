// One writer at a time.
#pragma once
#include <string>

namespace grainfield::coupling {

/// A lock that ends with the process that holds it, however it ends. The file says who holds it and
/// goes with the lock. Where the file system knows no locks, the process named in the file counts:
/// on this host as long as it lives, on another one always.
class FileLock {
 public:
  /// Takes the lock; `file` is made where missing, its folder must exist. `what` names what it
  /// guards, `hint` what to do instead, `command` who we are. Throws std::invalid_argument
  /// "WHAT: in use by process 12 on HOST (COMMAND); HINT" when somebody else has it, and naming the
  /// file when it cannot be written.
  FileLock(const std::string& file, const std::string& what, const std::string& hint,
           const std::string& command);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::string file_;
  int descriptor_ = -1;
};

}  // namespace grainfield::coupling
