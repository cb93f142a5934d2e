// Object headers of HDF5 files of the first version, looked at without the library (HDF5 File
// Format Specification 2.0, IV.A.1.a and IV.A.2.m). Its version 1.10 copies the value of an
// attribute from behind its name, type and space, wherever the sizes of these say that is: beyond
// the message, and beyond the memory that holds it. Headers of the second version carry checksums.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

namespace grainfield::dem::hdf5 {

/// `count` bytes of a file from `offset` on; fewer at its end.
using ReadBytes = std::function<std::string(std::uint64_t offset, std::uint64_t count)>;

/// Whether name, type and space of every attribute in the header at `address` end within their
/// message. True for a header of another version or kind, or one that is cut: the library says it.
bool attributes_end_within(const ReadBytes& read, std::uint64_t address);

}  // namespace grainfield::dem::hdf5
