// A file that is there, and may be whole, but cannot be read at this moment.
#pragma once
#include <cerrno>
#include <stdexcept>

namespace grainfield::dem {

/// No permission, too many open files, no memory, an I/O error, a lock of another program: nothing
/// is known about the file's content, so it must neither be taken for damaged nor be replaced. One
/// line that names the file.
class CannotReadNow : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Whether an errno of open or read stands for that.
inline bool means_cannot_read_now(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
    case EMFILE:
    case ENFILE:
    case ENOMEM:
    case EIO:
    case EAGAIN:
    case EINTR:
    case ESTALE:
    case ETIMEDOUT:
    case ENODEV:
    case ENXIO:
      return true;
    default:
      return false;
  }
}

}  // namespace grainfield::dem
