#include "dem/snapshot/hdf5_headers.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace grainfield::dem::hdf5 {
namespace {

constexpr std::uint64_t kAttribute = 0x000c, kContinuation = 0x0010;
constexpr std::uint64_t kPrefix = 16, kMessagePrefix = 8;  // bytes
constexpr unsigned kShared = 2;                   // flag of a message that stands elsewhere
constexpr std::size_t kMostParts = 1000;          // of one header
constexpr std::uint64_t kMostBytes = 16'000'000;  // of one part

// Little endian.
std::uint64_t number(const std::string& bytes, std::size_t at, std::size_t size) {
  std::uint64_t out = 0;
  for (std::size_t k = size; k-- > 0;) {
    out = out << 8 | static_cast<unsigned char>(bytes[at + k]);
  }
  return out;
}

// `message`: what stands behind its prefix.
bool ends_within(const std::string& message) {
  constexpr std::size_t sizes = 8;
  if (message.size() < sizes) return false;
  const auto version = number(message, 0, 1);
  std::uint64_t end = sizes + (version == 3 ? 1 : 0);
  for (const std::size_t at : {2, 4, 6}) {
    const std::uint64_t size = number(message, at, 2);
    end += version == 1 ? (size + 7) / 8 * 8 : size;
  }
  return end <= message.size();
}

using Part = std::pair<std::uint64_t, std::uint64_t>;  // place and bytes

// The messages of one part of a header; what it goes on with is added to `parts`.
bool messages_end_within(const std::string& bytes, std::vector<Part>& parts) {
  std::size_t at = 0;
  while (at + kMessagePrefix <= bytes.size()) {
    const std::uint64_t type = number(bytes, at, 2), size = number(bytes, at + 2, 2);
    const std::uint64_t flags = number(bytes, at + 4, 1);
    at += kMessagePrefix;
    if (at + size > bytes.size()) return true;  // the library says it
    const std::string message = bytes.substr(at, size);
    at += size;
    if (type == kContinuation && size >= 16 && parts.size() < kMostParts) {
      parts.emplace_back(number(message, 0, 8), number(message, 8, 8));
    }
    if (type == kAttribute && (flags & kShared) == 0 && !ends_within(message)) return false;
  }
  return true;
}

}  // namespace

bool attributes_end_within(const ReadBytes& read, std::uint64_t address) {
  const std::string prefix = read(address, kPrefix);
  if (prefix.size() < kPrefix || number(prefix, 0, 2) != 1) return true;
  std::vector<Part> parts{{address + kPrefix, number(prefix, 8, 4)}};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto [place, count] = parts[k];
    if (!messages_end_within(read(place, std::min(count, kMostBytes)), parts)) return false;
  }
  return true;
}

}  // namespace grainfield::dem::hdf5
