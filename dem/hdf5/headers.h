// Object headers of HDF5 files, looked at without the library.
//
// HDF5 1.10 trusts the sizes of name, datatype and dataspace in an attribute message: when they are
// larger than the message, it reads beyond the header's memory, and what is there depends on the
// process. A child that reads the file (trial_read.h) may survive what its parent does not. Headers
// of version 2 have checksums; these have none.
#pragma once
#include <cstdint>
#include <istream>

namespace grainfield::dem::hdf5 {

/// How a file writes addresses, as its superblock says.
struct AddressFormat {
  std::uint64_t base = 0;  ///< what addresses count from, bytes
  unsigned address = 8;    ///< bytes of an address
  unsigned length = 8;     ///< bytes of a length
};

/// False when an object header of version 1 at this address has an attribute that is larger than
/// its message, or messages that do not fit into the header or the file. True for other headers
/// ("HDF5 File Format Specification 2.0", IV.A.1.a and IV.A.2.m).
bool attributes_fit(std::istream& file, const AddressFormat& format, std::uint64_t header);

}  // namespace grainfield::dem::hdf5
