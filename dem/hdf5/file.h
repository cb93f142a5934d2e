// HDF5 handles that close themselves, and the few calls the project needs.
//
// What is written carries checksums: the metadata the library's own (the file format of HDF5 1.8),
// the data Fletcher-32 in their chunks and a CRC-32 beside them. No times: the same data give the
// same bytes.
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

/// Opens for reading, after a look at the file in a child process (trial_read.h). Throws
/// std::invalid_argument naming the file: not there, not HDF5, truncated, damaged; CannotReadNow
/// (dem/cannot_read_now.h) when the moment is to blame, here and in all that reads.
Handle open_for_reading(const std::string& file);
/// Opens to add to it, creating it when it is not there. Throws StorageFailed naming the file when
/// it cannot be created, std::invalid_argument when what is there cannot be read.
Handle open_for_adding(const std::string& file);
/// Writes what HDF5 still holds back and closes: a full disk often shows only here. Throws
/// StorageFailed naming the file.
void finish(Handle file, const std::string& name);

/// A new group below `parent`, with those on its path ("/realization_003/loaded"). Throws
/// StorageFailed; std::invalid_argument when it is there already.
Handle create_group(hid_t parent, const std::string& path);
/// The group of that name; throws std::invalid_argument naming the file when it is missing or
/// broken.
Handle open_group(hid_t parent, const std::string& name);

/// rows x columns doubles (row-major); columns = 1 gives a one-dimensional dataset. With a "unit"
/// attribute. Throws StorageFailed.
void write(hid_t group, const std::string& name, const std::vector<double>& values, int columns,
           const std::string& unit);
void write(hid_t group, const std::string& name, const std::vector<long long>& values, int columns,
           const std::string& unit);
void write_attribute(hid_t object, const std::string& name, const std::string& value);
void write_attribute(hid_t object, const std::string& name, double value);

/// The whole dataset; `columns` must fit. Throws std::invalid_argument naming `where` and the
/// dataset when it is missing, of another shape, or damaged (a checksum does not fit).
std::vector<double> read_doubles(hid_t group, const std::string& name, int columns,
                                 const std::string& where);
std::vector<long long> read_integers(hid_t group, const std::string& name, int columns,
                                     const std::string& where);
/// Uninterpreted bytes.
void write_bytes(hid_t group, const std::string& name, const std::string& bytes);
std::string read_bytes(hid_t group, const std::string& name, const std::string& where);

/// These throw std::invalid_argument naming the file and the object when that is damaged.
bool has_attribute(hid_t object, const std::string& name);
bool has_link(hid_t group, const std::string& name);
/// Whether the path leads through groups to a group.
bool has_group(hid_t parent, const std::string& path);
/// These throw std::invalid_argument, too, when there is no such attribute or it is of another
/// kind.
std::string read_text_attribute(hid_t object, const std::string& name);
double read_number_attribute(hid_t object, const std::string& name);
/// A whole number of at most 2^53.
long long read_integer_attribute(hid_t object, const std::string& name);
/// Whether it has this text; false when it is missing or of another kind.
bool attribute_is(hid_t object, const std::string& name, const std::string& value);
/// Names of all attributes of the object, and of those that hold one text or one number.
std::vector<std::string> attributes(hid_t object);
std::vector<std::string> text_attributes(hid_t object);
std::vector<std::string> number_attributes(hid_t object);
/// Names of the groups directly below, without those behind symbolic links.
std::vector<std::string> groups(hid_t object);
/// Where the object is in its file: the same for two names of one object.
haddr_t address(hid_t object);
/// A name of a file's object for a message: control characters replaced, at most 80 bytes.
std::string shown(const std::string& name);

}  // namespace grainfield::dem::hdf5
