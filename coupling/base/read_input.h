// Text that the user names: a file, or a pipe where the shell made one.
#pragma once
#include <cstddef>
#include <limits>
#include <string>

namespace grainfield::coupling {

struct InputLimits {
  std::size_t bytes =
      std::numeric_limits<std::size_t>::max();  ///< one more is read, and no further
  double seconds = 0;  ///< for a pipe to come to its end; 0: as long as somebody writes to it
};

/// The text of `file`, also of a pipe such as /dev/stdin or <(command). `expected` is what it
/// should be: "a case file". Throws std::invalid_argument "FILE: ..." when it is not there, cannot
/// be read, is a folder, a socket or a disk, is a pipe that nobody writes to, or one without an
/// end.
std::string read_input(const std::string& file, const std::string& expected,
                       const InputLimits& limits = {});

/// For files that are read more than once, or where only a file makes sense. Throws
/// std::invalid_argument "FILE: is a pipe, expected EXPECTED" for what is there and no regular
/// file; never waits.
void require_regular_file(const std::string& file, const std::string& expected);

}  // namespace grainfield::coupling
