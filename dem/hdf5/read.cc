// Reading of what may be damaged: every answer of HDF5 is looked at, every size before memory is
// taken for it.
#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "dem/cannot_read_now.h"
#include "dem/hdf5/crc.h"
#include "dem/hdf5/damage.h"
#include "dem/hdf5/file.h"

namespace grainfield::dem::hdf5 {
namespace {

// Numbers above are not whole any more in an attribute's double.
constexpr double kMostWhole = 9007199254740992;
// Bytes of a name in a message.
constexpr std::size_t kMostShown = 80;

// "FILE:/path" of an object.
std::string place(hid_t object) {
  const auto text = [&](auto get) {
    const ssize_t length = get(nullptr, 0);
    std::string name(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
    if (length > 0) get(name.data(), name.size() + 1);
    return name;
  };
  return text([&](char* to, std::size_t room) { return H5Fget_name(object, to, room); }) + ":" +
         shown(text([&](char* to, std::size_t room) { return H5Iget_name(object, to, room); }));
}

// The next two are to be called right after the call of HDF5 that failed.
const char* reason() {
  return checksum_failed() ? "its checksum does not fit: the file is damaged"
                           : "cannot be read: the file is truncated or broken";
}

[[noreturn]] void fail_read(const std::string& where, const std::string& what) {
  // Before the message asks HDF5 anything else. That the child could read it and we cannot is for
  // want of memory now.
  const int now = out_of_memory() ? ENOMEM : error_of_the_moment();
  if (now != 0) {
    throw CannotReadNow(
        fmt::format("{}: {}: cannot be read now: {}", where, what, std::strerror(now)));
  }
  throw std::invalid_argument(fmt::format("{}: {}: {}", where, what, reason()));
}

[[noreturn]] void fail_read(hid_t object, const std::string& what) {
  const char* why = reason();
  const int now = out_of_memory() ? ENOMEM : error_of_the_moment();
  if (now != 0) {
    throw CannotReadNow(
        fmt::format("{}: {}: cannot be read now: {}", place(object), what, std::strerror(now)));
  }
  throw std::invalid_argument(fmt::format("{}: {}: {}", place(object), what, why));
}

std::string attribute_called(const std::string& name) {
  return fmt::format("attribute '{}'", shown(name));
}

[[noreturn]] void fail_kind(hid_t object, const std::string& name, const char* wanted) {
  throw std::invalid_argument(
      fmt::format("{}: {} is not {}", place(object), attribute_called(name), wanted));
}

struct OpenAttribute {
  Handle id, type;
  H5T_class_t kind;
  bool single;
};

OpenAttribute open_attribute(hid_t object, const std::string& name) {
  if (!has_attribute(object, name)) {
    throw std::invalid_argument(
        fmt::format("{}: has no {}", place(object), attribute_called(name)));
  }
  Handle id(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!id.valid()) fail_read(object, attribute_called(name));
  Handle type(H5Aget_type(id), H5Tclose);
  const Handle space(H5Aget_space(id), H5Sclose);
  if (!type.valid() || !space.valid()) fail_read(object, attribute_called(name));
  const H5T_class_t kind = H5Tget_class(type);
  const bool single = H5Sget_simple_extent_npoints(space) == 1;
  return {std::move(id), std::move(type), kind, single};
}

bool is_number(const OpenAttribute& a) {
  return a.single && (a.kind == H5T_FLOAT || a.kind == H5T_INTEGER);
}

bool is_text(const OpenAttribute& a) { return a.single && a.kind == H5T_STRING; }

// h5py writes strings of variable length: HDF5 takes memory for them, which goes back to it.
std::string variable_text_of(hid_t object, const std::string& name, const OpenAttribute& a) {
  char* text = nullptr;
  if (H5Aread(a.id, a.type, static_cast<void*>(&text)) < 0) {
    fail_read(object, attribute_called(name));
  }
  std::string value = text == nullptr ? "" : text;
  H5free_memory(text);
  return value;
}

std::string text_of(hid_t object, const std::string& name, const OpenAttribute& a) {
  if (H5Tis_variable_str(a.type) > 0) return variable_text_of(object, name, a);
  const std::size_t size = H5Tget_size(a.type);
  if (size == 0 || size > file_size(object)) fail_read(object, attribute_called(name));
  std::string value(size, '\0');
  if (H5Aread(a.id, a.type, value.data()) < 0) fail_read(object, attribute_called(name));
  while (!value.empty() && value.back() == '\0') value.pop_back();
  return value;
}

template <class T>
void check_crc(hid_t set, const std::string& name, const std::vector<T>& values,
               const std::string& where) {
  if (!has_attribute(set, kCrc)) return;
  const std::string stored = read_text_attribute(set, kCrc), found = crc_of(values);
  if (stored == found) return;
  throw std::invalid_argument(
      fmt::format("{}: dataset '{}': its checksum does not fit: the file is damaged ({} {}, its "
                  "values give {})",
                  where, shown(name), kCrc, shown(stored), found));
}

template <class T>
std::vector<T> read_any(hid_t group, const std::string& name, int columns, const std::string& where,
                        hid_t type) {
  const std::string what = fmt::format("dataset '{}'", shown(name));
  if (!has_link(group, name)) throw std::invalid_argument(fmt::format("{}: no {}", where, what));
  const Handle set(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) fail_read(where, what);
  if (const std::string why = unreadable(set); !why.empty()) {
    throw std::invalid_argument(fmt::format("{}: {} is damaged or foreign: {}", where, what, why));
  }
  const Handle space(H5Dget_space(set), H5Sclose);
  hsize_t shape[2] = {0, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 2 || H5Sget_simple_extent_dims(space, shape, nullptr) < 0 ||
      shape[1] != static_cast<hsize_t>(columns)) {
    throw std::invalid_argument(
        fmt::format("{}: {} does not have {} column(s)", where, what, columns));
  }
  std::vector<T> values(shape[0] * shape[1]);
  if (!values.empty()) {
    if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      fail_read(where, what);
    }
    check_crc(set, name, values, where);
  }
  return values;
}

}  // namespace

std::string shown(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (out.size() >= kMostShown) return out + "...";
    out += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? '?' : c;
  }
  return out;
}

Handle open_group(hid_t parent, const std::string& name) {
  if (!has_link(parent, name)) {
    throw std::invalid_argument(fmt::format("{}: no group '{}'", place(parent), shown(name)));
  }
  Handle group(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose);
  if (!group.valid()) fail_read(parent, fmt::format("group '{}'", shown(name)));
  return group;
}

std::vector<double> read_doubles(hid_t group, const std::string& name, int columns,
                                 const std::string& where) {
  return read_any<double>(group, name, columns, where, H5T_NATIVE_DOUBLE);
}
std::vector<long long> read_integers(hid_t group, const std::string& name, int columns,
                                     const std::string& where) {
  return read_any<long long>(group, name, columns, where, H5T_NATIVE_LLONG);
}
std::string read_bytes(hid_t group, const std::string& name, const std::string& where) {
  const auto values = read_any<char>(group, name, 1, where, H5T_NATIVE_CHAR);
  return std::string(values.begin(), values.end());
}

bool has_attribute(hid_t object, const std::string& name) {
  const htri_t there = H5Aexists(object, name.c_str());
  if (there < 0) fail_read(object, attribute_called(name));
  return there > 0;
}

bool has_link(hid_t group, const std::string& name) {
  const htri_t there = H5Lexists(group, name.c_str(), H5P_DEFAULT);
  if (there < 0) fail_read(group, fmt::format("'{}'", shown(name)));
  return there > 0;
}

bool has_group(hid_t parent, const std::string& path) {
  for (std::size_t end = 0; end != std::string::npos;) {
    end = path.find('/', end + 1);
    const std::string part = path.substr(0, end);
    if (part.empty() || !has_link(parent, part)) return false;
    H5O_info_t info;
    if (H5Oget_info_by_name2(parent, part.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT) < 0 ||
        info.type != H5O_TYPE_GROUP) {
      return false;
    }
  }
  return true;
}

std::string read_text_attribute(hid_t object, const std::string& name) {
  const OpenAttribute a = open_attribute(object, name);
  if (!is_text(a)) fail_kind(object, name, "a text");
  return text_of(object, name, a);
}

bool attribute_is(hid_t object, const std::string& name, const std::string& value) {
  if (!has_attribute(object, name)) return false;
  const OpenAttribute a = open_attribute(object, name);
  return is_text(a) && text_of(object, name, a) == value;
}

double read_number_attribute(hid_t object, const std::string& name) {
  const OpenAttribute a = open_attribute(object, name);
  if (!is_number(a)) fail_kind(object, name, "a number");
  double value = 0;
  if (H5Aread(a.id, H5T_NATIVE_DOUBLE, &value) < 0) {
    fail_read(object, attribute_called(name));
  }
  return value;
}

long long read_integer_attribute(hid_t object, const std::string& name) {
  const double value = read_number_attribute(object, name);
  if (!(std::fabs(value) <= kMostWhole) || value != std::floor(value)) {
    throw std::invalid_argument(fmt::format("{}: {} is {:g}; it must be a whole number",
                                            place(object), attribute_called(name), value));
  }
  return static_cast<long long>(value);
}

std::vector<std::string> attributes(hid_t object) {
  std::vector<std::string> names;
  const herr_t done = H5Aiterate2(
      object, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5A_info_t*, void* data) -> herr_t {
        static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        return 0;
      },
      &names);
  if (done < 0) fail_read(object, "attributes");
  return names;
}

std::vector<std::string> text_attributes(hid_t object) {
  std::vector<std::string> names = attributes(object);
  std::erase_if(names,
                [&](const std::string& name) { return !is_text(open_attribute(object, name)); });
  return names;
}

std::vector<std::string> number_attributes(hid_t object) {
  std::vector<std::string> names = attributes(object);
  std::erase_if(names,
                [&](const std::string& name) { return !is_number(open_attribute(object, name)); });
  return names;
}

std::vector<std::string> groups(hid_t object) {
  std::vector<std::string> names;
  const herr_t done = H5Literate(
      object, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t* info, void* data) -> herr_t {
        if (info->type == H5L_TYPE_HARD) {
          static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        }
        return 0;
      },
      &names);
  if (done < 0) fail_read(object, "groups");
  std::erase_if(names, [&](const std::string& name) {
    H5O_info_t info;
    if (H5Oget_info_by_name2(object, name.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT) < 0) {
      fail_read(object, fmt::format("'{}'", shown(name)));
    }
    return info.type != H5O_TYPE_GROUP;
  });
  return names;
}

haddr_t address(hid_t object) {
  H5O_info_t info;
  if (H5Oget_info2(object, &info, H5O_INFO_BASIC) < 0) fail_read(object, "object");
  return info.addr;
}

}  // namespace grainfield::dem::hdf5
