// Ctrl-C and SIGTERM as a flag that long work looks at.
#pragma once
#include <stdexcept>

namespace grainfield::coupling {

/// The work was stopped from outside and can be continued; the message says how. Exit code 130.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// While it lives, SIGINT and SIGTERM set a flag instead of ending the program; a second signal
/// ends it at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
};

bool interrupted();

}  // namespace grainfield::coupling
