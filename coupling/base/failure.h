// What a failure means to whoever asked for the work.
#pragma once
#include <exception>
#include <string>
#include <vector>

namespace grainfield::coupling {

inline constexpr int kExitStorage = 74;  ///< an output cannot be written (EX_IOERR of sysexits.h)

struct Failure {
  /// 2: a mistake in what the user gave; 3: a computation that failed; 74: an output cannot be
  /// written; 130: stopped from outside (Interrupted); 1: anything else.
  int code = 1;
  std::string text;                        ///< one line, or one for each mistake
  std::vector<std::string> mistakes = {};  ///< several mistakes, a line each; else empty
};

/// The failure of an exception in flight, which must not be null.
Failure failure_of(const std::exception_ptr& error);

}  // namespace grainfield::coupling
