// Files with a wrong byte or without their end, and files as HDF5 writes them by default.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "dem/hdf5/file.h"
#include "dem/random/random.h"

#ifdef __SANITIZE_ADDRESS__
// The library keeps a little of every file that it gives up.
extern "C" [[gnu::used]] inline const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
#endif

namespace grainfield::testing {

inline std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A folder that goes with the test.
class TestFolder {
 public:
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "grainfield_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// The superblock and the first headers.
inline constexpr std::size_t kDense = 128;

/// How many damaged copies were refused, and how many of these by the look ahead.
struct Damage {
  int copies = 0, refused = 0, crashes = 0;
};

/// Reads copies of the file with one wrong byte each: the first kDense bytes, then every
/// `stride`-th. read(file) gives all that was read as bits. Each must end in one
/// std::invalid_argument that names the file, or, when `checked`, in the original's bits.
inline void flip_bytes(const std::string& file, const TestFolder& folder, std::size_t stride,
                       bool checked, const std::function<std::string(const std::string&)>& read,
                       Damage& found) {
  const std::string original = bytes_of(file), bits = read(file);
  dem::Random random(7);
  const auto look = [&](const std::string& damaged, const std::string& what) {
    // A new name each: two files with the same name and size may be written within one tick.
    const std::string copy = folder / ("copy" + std::to_string(found.copies++) + ".h5");
    std::ofstream(copy, std::ios::binary) << damaged;
    using std::chrono::hours;
    // An old file is looked at once.
    std::filesystem::last_write_time(copy,
                                     std::filesystem::file_time_type::clock::now() - hours(1));
    try {
      const std::string seen = read(copy);
      EXPECT_TRUE(!checked || seen == bits) << what << ": not noticed";
    } catch (const std::invalid_argument& e) {
      const std::string said = e.what();
      ++found.refused;
      found.crashes += said.find("reading it") != std::string::npos ? 1 : 0;
      EXPECT_EQ(said.rfind(copy, 0), 0U) << what << ": " << said;
      EXPECT_EQ(said.find('\n'), std::string::npos) << what << ": " << said;
    } catch (const std::exception& e) {
      ADD_FAILURE() << what << ": " << e.what();
    }
    // It stays, empty, so that its inode is no other copy's.
    std::filesystem::resize_file(copy, 0);
  };
  for (std::size_t at = 0; at < original.size(); at += at < kDense ? 1 : stride) {
    std::string damaged = original;
    const auto change = at % 2 == 0 ? 1 << static_cast<int>(8 * random.uniform())
                                    : 1 + static_cast<int>(255 * random.uniform());
    damaged[at] = static_cast<char>(damaged[at] ^ change);
    look(damaged, "byte " + std::to_string(at));
  }
  for (std::size_t size = 0; size < original.size(); size += 1 + 7 * stride) {
    look(original.substr(0, size), "cut at " + std::to_string(size));
  }
}

/// Copies a group's contents into another file without any checksum, as HDF5 does by default.
inline void copy_plainly(hid_t from, hid_t to) {
  namespace h5 = dem::hdf5;
  const auto attributes = [](hid_t source, hid_t target) {
    for (hsize_t k = 0;; ++k) {
      const h5::Handle a(
          H5Aopen_by_idx(source, ".", H5_INDEX_NAME, H5_ITER_INC, k, H5P_DEFAULT, H5P_DEFAULT),
          H5Aclose);
      if (!a.valid()) return;
      std::string name(H5Aget_name(a, 0, nullptr), '\0');
      H5Aget_name(a, name.size() + 1, name.data());
      if (name == "crc32") continue;
      const h5::Handle type(H5Aget_type(a), H5Tclose), space(H5Aget_space(a), H5Sclose);
      std::vector<char> value(H5Tget_size(type));
      H5Aread(a, type, value.data());
      const h5::Handle made(H5Acreate2(target, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                            H5Aclose);
      H5Awrite(made, type, value.data());
    }
  };
  attributes(from, to);
  for (hsize_t k = 0;; ++k) {
    const ssize_t length =
        H5Lget_name_by_idx(from, ".", H5_INDEX_NAME, H5_ITER_INC, k, nullptr, 0, H5P_DEFAULT);
    if (length < 0) return;
    std::string name(static_cast<std::size_t>(length), '\0');
    H5Lget_name_by_idx(from, ".", H5_INDEX_NAME, H5_ITER_INC, k, name.data(), name.size() + 1,
                       H5P_DEFAULT);
    const h5::Handle object(H5Oopen(from, name.c_str(), H5P_DEFAULT), H5Oclose);
    if (H5Iget_type(object) == H5I_GROUP) {
      const h5::Handle group(H5Gcreate2(to, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                             H5Gclose);
      copy_plainly(object, group);
      continue;
    }
    const h5::Handle type(H5Dget_type(object), H5Tclose), space(H5Dget_space(object), H5Sclose);
    const h5::Handle set(
        H5Dcreate2(to, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    std::vector<char> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) *
                             H5Tget_size(type));
    if (!values.empty()) {
      H5Dread(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
      H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    attributes(object, set);
  }
}

/// The same in whole files: what `file` would be without checksums.
inline void copy_plainly(const std::string& file, const std::string& plain) {
  const dem::hdf5::Handle from = dem::hdf5::open_for_reading(file);
  const dem::hdf5::Handle to(H5Fcreate(plain.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                             H5Fclose);
  const dem::hdf5::Handle source(H5Gopen2(from, "/", H5P_DEFAULT), H5Gclose);
  const dem::hdf5::Handle target(H5Gopen2(to, "/", H5P_DEFAULT), H5Gclose);
  copy_plainly(source, target);
}

}  // namespace grainfield::testing
