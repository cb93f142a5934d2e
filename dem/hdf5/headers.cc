#include "dem/hdf5/headers.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainfield::dem::hdf5 {
namespace {

// Bytes of a header before its messages, and of a message before its data.
constexpr std::uint64_t kHeaderPrefix = 16, kMessagePrefix = 8;
constexpr std::uint64_t kContinuation = 0x10, kAttribute = 0x0c, kShared = 2;

// The number in so many bytes, the lowest first.
std::uint64_t little_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t out = 0;
  for (std::size_t k = 0; k < count && k < sizeof(out); ++k) {
    out |= std::uint64_t{static_cast<unsigned char>(bytes[at + k])} << (8 * k);
  }
  return out;
}

// The message's data are given. A version that HDF5 does not know is its own matter.
bool attribute_fits(std::string_view data) {
  const std::uint64_t version = data.empty() ? 0 : little_endian(data, 0, 1);
  const std::size_t begin = version == 3 ? 9 : 8;
  if (data.size() < begin) return false;
  if (version < 1 || version > 3) return true;
  std::uint64_t end = begin;
  for (const std::size_t at : {2, 4, 6}) {
    const std::uint64_t size = little_endian(data, at, 2);
    end += version == 1 ? (size + 7) / 8 * 8 : size;
  }
  if (end > data.size()) return false;
  // HDF5 reads the name to its zero.
  return data.substr(begin, little_endian(data, 2, 2)).find('\0') != std::string_view::npos;
}

class Version1Header {
 public:
  Version1Header(std::istream& in, const AddressFormat& format) : in_(in), format_(format) {
    in_.clear();
    in_.seekg(0, std::ios::end);
    const std::streamoff size = in_.tellg();
    size_ = unread_ = size > 0 ? static_cast<std::uint64_t>(size) : 0;
  }

  bool fits(std::uint64_t at) {
    std::string prefix;
    if (!read(at, kHeaderPrefix, prefix) || prefix[0] != 1) return true;
    chunks_ = {{at + kHeaderPrefix, little_endian(prefix, 8, 4)}};
    while (!chunks_.empty()) {
      const auto [begin, bytes] = chunks_.back();
      chunks_.pop_back();
      if (!chunk_fits(begin, bytes)) return false;
    }
    return true;
  }

 private:
  bool read(std::uint64_t at, std::uint64_t bytes, std::string& to) {
    const std::uint64_t begin = format_.base + at;
    if (begin < at || begin > size_ || bytes > size_ - begin) return false;
    to.resize(bytes);
    in_.seekg(static_cast<std::streamoff>(begin));
    return static_cast<bool>(in_.read(to.data(), static_cast<std::streamsize>(bytes)));
  }

  // All chunks together are no larger than the file: those in a circle come to an end.
  bool chunk_fits(std::uint64_t begin, std::uint64_t bytes) {
    std::string chunk;
    if (bytes > unread_ || !read(begin, bytes, chunk)) return false;
    unread_ -= bytes;
    std::string_view rest = chunk;
    while (rest.size() >= kMessagePrefix) {
      const std::uint64_t size = little_endian(rest, 2, 2);
      if (size > rest.size() - kMessagePrefix) return false;
      if (!message_fits(rest, rest.substr(kMessagePrefix, size))) return false;
      rest.remove_prefix(kMessagePrefix + size);
    }
    return true;
  }

  bool message_fits(std::string_view prefix, std::string_view data) {
    const std::uint64_t type = little_endian(prefix, 0, 2);
    if (type == kContinuation) {
      if (data.size() < format_.address + format_.length) return false;
      chunks_.emplace_back(little_endian(data, 0, format_.address),
                           little_endian(data, format_.address, format_.length));
    }
    const bool shared = (little_endian(prefix, 4, 1) & kShared) != 0;
    return type != kAttribute || shared || attribute_fits(data);
  }

  std::istream& in_;
  AddressFormat format_;
  std::uint64_t size_ = 0, unread_ = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> chunks_;  // where, and bytes
};

}  // namespace

bool attributes_fit(std::istream& file, const AddressFormat& format, std::uint64_t header) {
  return Version1Header(file, format).fits(header);
}

}  // namespace grainfield::dem::hdf5
