// Object headers whose attributes are larger than their messages: HDF5 reads beyond their memory.
#include <gmock/gmock.h>

#include <limits>
#include <sstream>

#include "dem/hdf5/headers.h"
#include "dem/hdf5/trial_read.h"
#include "tests/damaged_files.h"
#include "tests/dem/snapshot_scene.h"

namespace grainfield::dem {
namespace {

using grainfield::testing::bytes_of;
using grainfield::testing::TestFolder;

// Little endian, in so many bytes.
std::string number(std::uint64_t value, int bytes) {
  std::string out;
  for (int k = 0; k < bytes; ++k) out += static_cast<char>(value >> (8 * k));
  return out;
}

std::string message(int type, const std::string& data, int flags = 0) {
  return number(static_cast<std::uint64_t>(type), 2) + number(data.size(), 2) +
         number(static_cast<std::uint64_t>(flags), 4) + data;
}

// With a name of four letters, and types and spaces of so many bytes behind it.
std::string attribute(int version, std::uint64_t name, std::uint64_t type, std::uint64_t space,
                      std::size_t bytes) {
  std::string out = number(static_cast<std::uint64_t>(version), 2) + number(name, 2) +
                    number(type, 2) + number(space, 2) + (version == 3 ? "\x01" : "") + "unit";
  out.resize(bytes, '\0');
  return message(0x0c, out);
}

std::string header(const std::string& messages) {
  return number(1, 2) + number(1, 2) + number(1, 4) + number(messages.size(), 8) + messages;
}

bool fit(const std::string& file, std::uint64_t at = 0, const hdf5::AddressFormat& format = {}) {
  std::istringstream in(file);
  return hdf5::attributes_fit(in, format, at);
}

std::string continuation(std::uint64_t at, std::uint64_t bytes) {
  return message(0x10, number(at, 8) + number(bytes, 8));
}

TEST(Hdf5Headers, AnAttributeEndsWithinItsMessage) {
  EXPECT_TRUE(fit(header(attribute(1, 5, 8, 8, 32))));
  EXPECT_FALSE(fit(header(attribute(1, 5, 8, 9, 32))));
  EXPECT_FALSE(fit(header(attribute(1, 5, 63752, 8, 32))));
  EXPECT_FALSE(fit(header(attribute(1, 9, 8, 8, 32))));
  // Later versions fill nothing up; the third has one more byte.
  EXPECT_TRUE(fit(header(attribute(2, 5, 8, 8, 29))));
  EXPECT_FALSE(fit(header(attribute(2, 5, 8, 8, 28))));
  EXPECT_TRUE(fit(header(attribute(3, 5, 8, 8, 30))));
  EXPECT_FALSE(fit(header(attribute(3, 5, 8, 8, 29))));
  // The name has its end.
  EXPECT_FALSE(fit(header(attribute(1, 4, 8, 8, 32))));
  EXPECT_FALSE(fit(header(attribute(1, 0, 8, 8, 32))));
  EXPECT_FALSE(fit(header(message(0x0c, ""))));
  EXPECT_FALSE(fit(header(message(0x0c, number(1, 7)))));
}

TEST(Hdf5Headers, OtherMessagesAndHeadersAreNoMatter) {
  EXPECT_TRUE(fit(""));
  EXPECT_TRUE(fit("OHDR" + std::string(100, '\xff')));
  EXPECT_TRUE(fit(header("")));
  EXPECT_TRUE(fit(header(message(0x0b, std::string(8, '\xff')))));
  // A shared one is a place elsewhere.
  EXPECT_TRUE(fit(header(message(0x0c, number(3, 10), 2))));
  EXPECT_FALSE(fit(header(message(0x0b, "") + attribute(1, 5, 99, 8, 32))));
  // A message, or the header itself, that has no end.
  EXPECT_FALSE(fit(header(message(0x0b, std::string(8, 'x')).substr(0, 12))));
  EXPECT_FALSE(fit(header(message(0x0b, "four")).substr(0, 20)));
}

TEST(Hdf5Headers, ContinuationsAreFollowedAndComeToAnEnd) {
  const std::string good = attribute(1, 5, 8, 8, 32), bad = attribute(1, 5, 99, 8, 32);
  const std::string first = header(continuation(40, good.size()));
  ASSERT_EQ(first.size(), 40U);
  EXPECT_TRUE(fit(first + good));
  EXPECT_FALSE(fit(first + bad));
  // Addresses count from the base.
  EXPECT_TRUE(fit("user block" + first + good, 0, {10, 8, 8}));
  EXPECT_FALSE(fit("user block" + first + bad, 0, {10, 8, 8}));
  // In four bytes each.
  const std::string narrow = header(message(0x10, number(32, 4) + number(good.size(), 4)));
  ASSERT_EQ(narrow.size(), 32U);
  EXPECT_TRUE(fit(narrow + good, 0, {0, 4, 4}));
  EXPECT_FALSE(fit(narrow + bad, 0, {0, 4, 4}));
  // In a circle, outside of the file, and without its address.
  EXPECT_FALSE(fit(header(continuation(16, 24))));
  EXPECT_FALSE(fit(header(continuation(0, std::numeric_limits<std::uint64_t>::max()))));
  EXPECT_FALSE(fit(header(continuation(std::numeric_limits<std::uint64_t>::max(), 24))));
  EXPECT_FALSE(fit(header(message(0x10, number(40, 8)))));
}

std::string said_of(const std::string& file) {
  try {
    hdf5::open_for_reading(file);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

// Enlarges one size in every attribute of version 1 with that name.
std::string enlarge(std::string bytes, const std::string& name, std::size_t offset) {
  const std::string begin = number(1, 2) + number(name.size() + 1, 2);
  int found = 0;
  for (std::size_t at = 8; (at = bytes.find(name + '\0', at)) != std::string::npos; ++at) {
    if (bytes.compare(at - 8, begin.size(), begin) != 0) continue;
    bytes[at - 8 + offset + 1] = '\xf9';
    ++found;
  }
  EXPECT_GT(found, 0);
  return bytes;
}

void expect_refused(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
  const std::string expected = file + ": damaged: an attribute is larger than its place";
  EXPECT_EQ(said_of(file), expected);
  const hdf5::StructureOnly alone;
  EXPECT_EQ(said_of(file), expected);
}

TEST(Hdf5Headers, AFileWithSuchAnAttributeIsRefused) {
  const TestFolder folder;
  write_snapshot(folder / "s.h5", "/a/loaded", small_snapshot());
  const std::string plain = folder / "plain.h5";
  grainfield::testing::copy_plainly(folder / "s.h5", plain);
  EXPECT_EQ(said_of(plain), "");
  const std::string bytes = bytes_of(plain);
  // Attributes of datasets and of groups; the datatype and the dataspace.
  int copies = 0;
  for (const char* name : {"unit", "time"}) {
    for (const std::size_t offset : {4, 6}) {
      expect_refused(folder / ("wrong" + std::to_string(copies++) + ".h5"),
                     enlarge(bytes, name, offset));
    }
  }
}

TEST(Hdf5Headers, OneBehindAUserBlockIsRefused) {
  const TestFolder folder;
  const std::string good = folder / "good.h5";
  {
    const hdf5::Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_userblock(properties, 512);
    const hdf5::Handle out(H5Fcreate(good.c_str(), H5F_ACC_EXCL, properties, H5P_DEFAULT),
                           H5Fclose);
    const hdf5::Handle root(H5Gopen2(out, "/", H5P_DEFAULT), H5Gclose);
    hdf5::write_attribute(root, "word", "w");
  }
  EXPECT_EQ(said_of(good), "");
  expect_refused(folder / "wrong.h5", enlarge(bytes_of(good), "word", 6));
}

}  // namespace
}  // namespace grainfield::dem
