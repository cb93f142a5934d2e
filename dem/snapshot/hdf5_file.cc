#include "dem/snapshot/hdf5_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <mutex>
#include <stdexcept>

namespace grainfield::dem::hdf5 {
namespace {

// HDF5 prints its own error stack; ours is one line. And we close what we open: at the program's
// end HDF5 would write once more to files that could not be closed on a full disk, and crash.
void prepare() {
  static std::once_flag once;
  std::call_once(once, [] {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  });
}

[[noreturn]] void fail_write(const std::string& name) {
  throw std::runtime_error(fmt::format("cannot write the HDF5 dataset or attribute '{}'", name));
}

template <class T>
void write_any(hid_t group, const std::string& name, const std::vector<T>& values, int columns,
               const std::string& unit, hid_t type) {
  const hsize_t rows = values.size() / static_cast<std::size_t>(columns);
  const hsize_t shape[2] = {rows, static_cast<hsize_t>(columns)};
  const Handle space(H5Screate_simple(columns == 1 ? 1 : 2, shape, nullptr), H5Sclose);
  // Without the time of writing: the same data give the same bits.
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties, false);
  const Handle set(
      H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
  if (!set.valid()) fail_write(name);
  if (rows > 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    fail_write(name);
  }
  if (!unit.empty()) write_attribute(set, "unit", unit);
}

template <class T>
std::vector<T> read_any(hid_t group, const std::string& name, int columns, const std::string& where,
                        hid_t type) {
  const Handle set(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) {
    throw std::invalid_argument(fmt::format("{}: no dataset '{}'", where, name));
  }
  const Handle space(H5Dget_space(set), H5Sclose);
  hsize_t shape[2] = {0, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 2 || H5Sget_simple_extent_dims(space, shape, nullptr) < 0 ||
      shape[1] != static_cast<hsize_t>(columns)) {
    throw std::invalid_argument(
        fmt::format("{}: dataset '{}' does not have {} column(s)", where, name, columns));
  }
  std::vector<T> values(shape[0] * shape[1]);
  if (!values.empty() && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    throw std::invalid_argument(fmt::format(
        "{}: dataset '{}' cannot be read: the file is truncated or broken", where, name));
  }
  return values;
}

}  // namespace

Handle open_for_reading(const std::string& file) {
  prepare();
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw std::invalid_argument(fmt::format("{}: no such file", file));
  }
  if (std::filesystem::is_directory(file, error)) {
    throw std::invalid_argument(
        fmt::format("{0}: a folder; name its file, such as {0}/snapshots.h5", file));
  }
  if (H5Fis_hdf5(file.c_str()) <= 0) {
    throw std::invalid_argument(
        fmt::format("{}: not an HDF5 file, or its beginning is broken", file));
  }
  Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!handle.valid()) {
    throw std::invalid_argument(fmt::format("{}: the HDF5 file is truncated or broken", file));
  }
  return handle;
}

Handle open_for_adding(const std::string& file) {
  prepare();
  std::error_code error;
  const bool there = std::filesystem::exists(file, error);
  Handle handle(there ? H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)
                      : H5Fcreate(file.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT),
                H5Fclose);
  if (!handle.valid()) throw std::runtime_error(fmt::format("{}: cannot be written", file));
  return handle;
}

void finish(Handle file, const std::string& name) {
  const bool flushed = H5Fflush(file, H5F_SCOPE_LOCAL) >= 0;
  if (!file.close_now() || !flushed) {
    throw std::runtime_error(
        fmt::format("{}: cannot be written to its end; is the disk full?", name));
  }
}

void write(hid_t group, const std::string& name, const std::vector<double>& values, int columns,
           const std::string& unit) {
  write_any(group, name, values, columns, unit, H5T_NATIVE_DOUBLE);
}
void write(hid_t group, const std::string& name, const std::vector<long long>& values, int columns,
           const std::string& unit) {
  write_any(group, name, values, columns, unit, H5T_NATIVE_LLONG);
}

void write_attribute(hid_t object, const std::string& name, const std::string& value) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, value.empty() ? 1 : value.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute, type, value.empty() ? "" : value.data()) < 0) {
    fail_write(name);
  }
}
void write_attribute(hid_t object, const std::string& name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(
      H5Acreate2(object, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) < 0) fail_write(name);
}

std::vector<double> read_doubles(hid_t group, const std::string& name, int columns,
                                 const std::string& where) {
  return read_any<double>(group, name, columns, where, H5T_NATIVE_DOUBLE);
}
std::vector<long long> read_integers(hid_t group, const std::string& name, int columns,
                                     const std::string& where) {
  return read_any<long long>(group, name, columns, where, H5T_NATIVE_LLONG);
}

void write_bytes(hid_t group, const std::string& name, const std::string& bytes) {
  write_any(group, name, std::vector<char>(bytes.begin(), bytes.end()), 1, "", H5T_NATIVE_CHAR);
}
std::string read_bytes(hid_t group, const std::string& name, const std::string& where) {
  const auto values = read_any<char>(group, name, 1, where, H5T_NATIVE_CHAR);
  return std::string(values.begin(), values.end());
}

bool has_attribute(hid_t object, const std::string& name) {
  return H5Aexists(object, name.c_str()) > 0;
}

std::string read_text_attribute(hid_t object, const std::string& name) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) throw std::invalid_argument(fmt::format("no attribute '{}'", name));
  const Handle type(H5Aget_type(attribute), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) {
    throw std::invalid_argument(fmt::format("attribute '{}' is not a text of fixed length", name));
  }
  std::string value(H5Tget_size(type), '\0');
  H5Aread(attribute, type, value.data());
  while (!value.empty() && value.back() == '\0') value.pop_back();
  return value;
}

double read_number_attribute(hid_t object, const std::string& name) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  double value = 0;
  if (!attribute.valid() || H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0) {
    throw std::invalid_argument(fmt::format("no number attribute '{}'", name));
  }
  return value;
}

std::vector<std::string> text_attributes(hid_t object) {
  std::vector<std::string> names;
  H5Aiterate2(
      object, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t location, const char* name, const H5A_info_t*, void* data) -> herr_t {
        const Handle attribute(H5Aopen(location, name, H5P_DEFAULT), H5Aclose);
        const Handle type(H5Aget_type(attribute), H5Tclose);
        if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) <= 0) {
          static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        }
        return 0;
      },
      &names);
  return names;
}

std::vector<std::string> groups(hid_t object) {
  std::vector<std::string> names;
  H5Literate(
      object, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t location, const char* name, const H5L_info_t*, void* data) -> herr_t {
        const Handle child(H5Gopen2(location, name, H5P_DEFAULT), H5Gclose);
        if (child.valid()) static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        return 0;
      },
      &names);
  return names;
}

}  // namespace grainfield::dem::hdf5
