// A checksum of a dataset's values, kept beside them: it also notices when the library finds whole
// but wrong chunks, or none.
#pragma once
#include <fmt/format.h>

#include <boost/crc.hpp>
#include <string>
#include <vector>

namespace grainfield::dem::hdf5 {

/// The attribute that holds it.
inline constexpr const char* kCrc = "crc32";

/// CRC-32 (that of zlib) of the values' bytes, eight hexadecimal digits.
template <class T>
std::string crc_of(const std::vector<T>& values) {
  boost::crc_32_type crc;
  crc.process_bytes(values.data(), values.size() * sizeof(T));
  return fmt::format("{:08x}", crc.checksum());
}

}  // namespace grainfield::dem::hdf5
