// HDF5 handles that close themselves, and the few calls the project needs.
#pragma once
#include <hdf5.h>

#include <string>
#include <vector>

namespace grainfield::dem::hdf5 {

/// Owns an HDF5 identifier.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// Closes now; false when HDF5 could not.
  bool close_now() {
    const hid_t id = id_;
    id_ = -1;
    return close_(id) >= 0;
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Opens for reading. Throws std::invalid_argument naming the file: not there, not HDF5, truncated.
Handle open_for_reading(const std::string& file);
/// Opens to add to it, creating it when it is not there. Throws std::runtime_error naming the file.
Handle open_for_adding(const std::string& file);
/// Writes what HDF5 still holds back and closes: a full disk often shows only here. Throws
/// std::runtime_error naming the file.
void finish(Handle file, const std::string& name);

/// rows x columns doubles (row-major); columns = 1 gives a one-dimensional dataset. With a "unit"
/// attribute. Throws std::runtime_error.
void write(hid_t group, const std::string& name, const std::vector<double>& values, int columns,
           const std::string& unit);
void write(hid_t group, const std::string& name, const std::vector<long long>& values, int columns,
           const std::string& unit);
void write_attribute(hid_t object, const std::string& name, const std::string& value);
void write_attribute(hid_t object, const std::string& name, double value);

/// The whole dataset; `columns` must fit. Throws std::invalid_argument naming `where` and the
/// dataset when it is missing or of another shape.
std::vector<double> read_doubles(hid_t group, const std::string& name, int columns,
                                 const std::string& where);
std::vector<long long> read_integers(hid_t group, const std::string& name, int columns,
                                     const std::string& where);
/// Uninterpreted bytes.
void write_bytes(hid_t group, const std::string& name, const std::string& bytes);
std::string read_bytes(hid_t group, const std::string& name, const std::string& where);
bool has_attribute(hid_t object, const std::string& name);
std::string read_text_attribute(hid_t object, const std::string& name);
double read_number_attribute(hid_t object, const std::string& name);
/// Names of all text attributes of the object.
std::vector<std::string> text_attributes(hid_t object);
/// Names of the groups directly below.
std::vector<std::string> groups(hid_t object);

}  // namespace grainfield::dem::hdf5
