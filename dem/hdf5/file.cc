#include "dem/hdf5/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "dem/cannot_read_now.h"
#include "dem/hdf5/crc.h"
#include "dem/hdf5/damage.h"
#include "dem/hdf5/replace_file.h"
#include "dem/hdf5/trial_read.h"
#include "dem/storage_failed.h"

namespace grainfield::dem::hdf5 {
namespace {

// Bytes of a chunk at most: larger ones need more memory when written and read.
constexpr std::size_t kChunk = 4 << 20;

// The formats of HDF5 1.8: its metadata have checksums, those of 1.6 have none.
Handle access() {
  Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(properties, H5F_LIBVER_V18, H5F_LIBVER_V18);
  return properties;
}

Handle create(const std::string& file) {
  const Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties, false);
  Handle handle(H5Fcreate(file.c_str(), H5F_ACC_EXCL, properties, access()), H5Fclose);
  if (!handle.valid()) {
    throw StorageFailed(fmt::format("{}: cannot be written; is the disk full?", final_name(file)));
  }
  return handle;
}

std::string file_name(hid_t object) {
  const ssize_t length = H5Fget_name(object, nullptr, 0);
  std::string name(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  if (length > 0) H5Fget_name(object, name.data(), name.size() + 1);
  return name;
}

// Throws when this errno, 0 for none, says that the moment is to blame and not the file.
void require_readable_now(const std::string& file, int error) {
  if (!means_cannot_read_now(error)) return;
  throw CannotReadNow(fmt::format("{}: cannot be read now: {}", file, std::strerror(error)));
}

// Opens it and reads its first bytes, as HDF5 will.
void try_reading(const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  int failed = descriptor < 0 ? errno : 0;
  char byte = 0;
  if (descriptor >= 0 && ::pread(descriptor, &byte, 1, 0) < 0) failed = errno;
  if (descriptor >= 0) ::close(descriptor);
  require_readable_now(file, failed);
}

[[noreturn]] void fail_write(hid_t object) {
  throw StorageFailed(fmt::format("{}: cannot be written to its end; is the disk full?",
                                  final_name(file_name(object))));
}

// In chunks with a checksum each; without the time of writing.
Handle properties_of_dataset(hsize_t rows, hsize_t columns, std::size_t size) {
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties, false);
  if (rows == 0) return properties;
  const hsize_t chunks = (rows * columns * size + kChunk - 1) / kChunk;
  const hsize_t shape[2] = {(rows + chunks - 1) / chunks, columns};
  H5Pset_chunk(properties, columns == 1 ? 1 : 2, shape);
  H5Pset_fletcher32(properties);
  H5Pset_fill_time(properties, H5D_FILL_TIME_ALLOC);  // behind the last row: zeros
  return properties;
}

template <class T>
void write_any(hid_t group, const std::string& name, const std::vector<T>& values, int columns,
               const std::string& unit, hid_t type) {
  const hsize_t rows = values.size() / static_cast<std::size_t>(columns);
  const hsize_t shape[2] = {rows, static_cast<hsize_t>(columns)};
  const Handle space(H5Screate_simple(columns == 1 ? 1 : 2, shape, nullptr), H5Sclose);
  const Handle properties = properties_of_dataset(rows, static_cast<hsize_t>(columns), sizeof(T));
  Handle set(H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
             H5Dclose);
  if (!set.valid()) fail_write(group);
  if (rows > 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    fail_write(group);
  }
  if (!unit.empty()) write_attribute(set, "unit", unit);
  if (rows > 0) write_attribute(set, kCrc, crc_of(values));
  // The last chunk is written now.
  if (H5Dflush(set) < 0 || !set.close_now()) fail_write(group);
}

void write_scalar(hid_t object, const std::string& name, hid_t type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute, type, value) < 0 || !attribute.close_now()) {
    fail_write(object);
  }
}

}  // namespace

Handle open_for_reading(const std::string& file) {
  prepare();
  std::error_code error;
  const bool there = std::filesystem::exists(file, error);
  if (error) require_readable_now(file, error.value());
  if (!there) throw std::invalid_argument(fmt::format("{}: no such file", file));
  if (std::filesystem::is_directory(file, error)) {
    throw std::invalid_argument(
        fmt::format("{0}: a folder; name its file, such as {0}/snapshots.h5", file));
  }
  if (!std::filesystem::is_regular_file(file, error)) {
    throw std::invalid_argument(fmt::format("{}: not a regular file", file));
  }
  if (::access(file.c_str(), R_OK) != 0) {
    throw CannotReadNow(fmt::format("{}: no permission to read it", file));
  }
  try_reading(file);
  if (H5Fis_hdf5(file.c_str()) <= 0) {
    throw std::invalid_argument(
        fmt::format("{}: not an HDF5 file, or its beginning is broken", file));
  }
  read_on_trial(file);
  Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!handle.valid()) {
    require_readable_now(file, out_of_memory() ? ENOMEM : error_of_the_moment());
    const char* checksum = checksum_failed() ? " (its checksum does not fit)" : "";
    throw std::invalid_argument(
        fmt::format("{}: the HDF5 file is truncated or broken{}", file, checksum));
  }
  return handle;
}

Handle open_for_adding(const std::string& file) {
  prepare();
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return create(file);
  read_on_trial(file);
  Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDWR, access()), H5Fclose);
  if (handle.valid()) return handle;
  // What cannot be read either is said as such.
  open_for_reading(file);
  throw StorageFailed(fmt::format("{}: cannot be written; is the disk full?", final_name(file)));
}

void finish(Handle file, const std::string& name) {
  const std::string own_name = file_name(file);
  const bool flushed = H5Fflush(file, H5F_SCOPE_LOCAL) >= 0;
  if (!file.close_now() || !flushed) {
    throw StorageFailed(
        fmt::format("{}: cannot be written to its end; is the disk full?", final_name(name)));
  }
  trust(own_name);
}

Handle create_group(hid_t parent, const std::string& path) {
  const Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties, false);
  // The groups on its way one by one: those that HDF5 makes by itself keep the time.
  std::size_t end = path.find('/', 1);
  for (; end != std::string::npos; end = path.find('/', end + 1)) {
    const std::string above = path.substr(0, end);
    if (has_link(parent, above)) continue;
    const Handle made(H5Gcreate2(parent, above.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT),
                      H5Gclose);
    if (!made.valid()) fail_write(parent);
  }
  if (has_link(parent, path)) {
    throw std::invalid_argument(
        fmt::format("{}: has a group '{}' already", file_name(parent), shown(path)));
  }
  Handle group(H5Gcreate2(parent, path.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT), H5Gclose);
  if (!group.valid()) fail_write(parent);
  return group;
}

void write(hid_t group, const std::string& name, const std::vector<double>& values, int columns,
           const std::string& unit) {
  write_any(group, name, values, columns, unit, H5T_NATIVE_DOUBLE);
}
void write(hid_t group, const std::string& name, const std::vector<long long>& values, int columns,
           const std::string& unit) {
  write_any(group, name, values, columns, unit, H5T_NATIVE_LLONG);
}
void write_bytes(hid_t group, const std::string& name, const std::string& bytes) {
  write_any(group, name, std::vector<char>(bytes.begin(), bytes.end()), 1, "", H5T_NATIVE_CHAR);
}

void write_attribute(hid_t object, const std::string& name, const std::string& value) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, value.empty() ? 1 : value.size());
  write_scalar(object, name, type, value.empty() ? "" : value.data());
}
void write_attribute(hid_t object, const std::string& name, double value) {
  write_scalar(object, name, H5T_NATIVE_DOUBLE, &value);
}

}  // namespace grainfield::dem::hdf5
