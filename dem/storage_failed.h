// An output that cannot be written is neither the user's mistake nor a failed computation.
#pragma once
#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace grainfield::dem {

/// An output cannot be written: disk full, file too large, quota, I/O error. One line that names
/// the file.
class StorageFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether a call of the system failed for what StorageFailed stands for.
inline bool means_storage_failed(const std::error_code& error) {
  return error == std::errc::no_space_on_device || error == std::errc::file_too_large ||
         error == std::errc::io_error || error == std::errc::read_only_file_system ||
         error == std::error_code(EDQUOT, std::generic_category());
}

}  // namespace grainfield::dem
