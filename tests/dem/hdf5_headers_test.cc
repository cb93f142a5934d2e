// Attributes that reach beyond their messages, in object headers read without the library.
#include "dem/snapshot/hdf5_headers.h"

#include <gtest/gtest.h>

namespace grainfield::dem::hdf5 {
namespace {

std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int k = 0; k < bytes; ++k) out += static_cast<char>(value >> 8 * k & 0xff);
  return out;
}

std::string message(int type, const std::string& body, int flags = 0) {
  return little(type, 2) + little(body.size(), 2) + little(flags, 1) + std::string(3, '\0') + body;
}

// Sizes as they say, and what follows them.
std::string attribute(int version, int name, int type, int space, std::size_t behind) {
  return little(version, 1) + little(0, 1) + little(name, 2) + little(type, 2) + little(space, 2) +
         std::string(behind, 'x');
}

std::string header(const std::string& messages) {
  return little(1, 2) + little(1, 2) + little(1, 4) + little(messages.size(), 4) + little(0, 4) +
         messages;
}

bool fits(const std::string& file, std::uint64_t address = 0) {
  return attributes_end_within(
      [&](std::uint64_t at, std::uint64_t n) {
        return at < file.size() ? file.substr(at, n) : std::string();
      },
      address);
}

TEST(Hdf5Headers, EveryVersionOfAnAttribute) {
  for (const int version : {1, 2, 3}) {
    const int padded = version == 1 ? 8 + 16 + 8 : 5 + 9 + 4 + (version == 3 ? 1 : 0);
    EXPECT_TRUE(fits(header(message(0x0c, attribute(version, 5, 9, 4, padded))))) << version;
    EXPECT_FALSE(fits(header(message(0x0c, attribute(version, 5, 9, 4, padded - 1))))) << version;
    EXPECT_FALSE(fits(header(message(0x0c, attribute(version, 5, 0xffff, 4, padded))))) << version;
  }
  EXPECT_FALSE(fits(header(message(0x0c, "\x01"))));
}

TEST(Hdf5Headers, OthersAreTheLibrarysMatter) {
  const std::string bad = attribute(1, 5, 0xffff, 4, 40);
  EXPECT_TRUE(fits(header(message(0x0c, bad, 2))));        // shared: it stands elsewhere
  EXPECT_TRUE(fits(header(message(0x05, bad))));           // no attribute
  EXPECT_TRUE(fits("OHDR" + header(message(0x0c, bad))));  // the second version
  EXPECT_TRUE(fits(""));
  EXPECT_TRUE(fits(header(message(0x0c, bad)).substr(0, 30)));
}

TEST(Hdf5Headers, PartsThatFollow) {
  const std::string bad = message(0x0c, attribute(1, 5, 0xffff, 4, 40));
  const auto goes_on = [&](std::uint64_t place, std::uint64_t size) {
    return message(0x10, little(place, 8) + little(size, 8));
  };
  const std::string first = header(goes_on(100, bad.size()));
  EXPECT_FALSE(fits(first + std::string(100 - first.size(), '\0') + bad));
  // One that goes on with itself comes to an end.
  EXPECT_TRUE(fits(header(goes_on(16, 24))));
  EXPECT_TRUE(fits(header(goes_on(~0ULL, ~0ULL))));
}

}  // namespace
}  // namespace grainfield::dem::hdf5
