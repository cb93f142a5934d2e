#include "dem/hdf5/trial_read.h"

#include <fmt/format.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "dem/cannot_read_now.h"
#include "dem/hdf5/child.h"
#include "dem/hdf5/damage.h"
#include "dem/hdf5/file.h"
#include "dem/hdf5/headers.h"

namespace grainfield::dem::hdf5 {
namespace {

// CPU time of the child: so much, and so many bytes more per second. Whole files are read at
// hundreds of MB/s, compressed ones of many small sets at tens, on a busy machine at less.
constexpr double kSeconds = 2, kBytesPerSecond = 4e6;
// Memory beyond what the process has: so many bytes, and times the file's size (numbers of one byte
// become eight; compressed ones more).
constexpr double kMemory = 512e6, kMemoryShare = 40;
// Younger files may change without their time changing, ns.
constexpr long long kYoung = 50'000'000;
constexpr int kDeepest = 256;
// The same where the structure alone is looked at, whatever the size; s on the clock besides.
constexpr double kStructureSeconds = 2, kStructureClock = 4, kStructureMemory = 64e6;
// Bytes of a number in memory.
constexpr double kNumber = 8;

// A state of a file: device, inode, bytes, time of change.
using State = std::tuple<dev_t, ino_t, off_t, long long>;

long long nanoseconds(const timespec& t) { return 1'000'000'000LL * t.tv_sec + t.tv_nsec; }

bool state_of(const std::string& file, State& state) {
  struct stat s {};
  if (stat(file.c_str(), &s) != 0) return false;
  state = {s.st_dev, s.st_ino, s.st_size, nanoseconds(s.st_mtim)};
  return true;
}

std::set<State>& known() {
  static std::set<State> states;
  return states;
}
// Those of whose structure alone is known that it can be read.
std::set<State>& known_structures() {
  static std::set<State> states;
  return states;
}

AddressFormat format_of(hid_t file) {
  const Handle properties(H5Fget_create_plist(file), H5Pclose);
  hsize_t base = 0;
  std::size_t address = 0, length = 0;
  if (H5Pget_userblock(properties, &base) < 0 || H5Pget_sizes(properties, &address, &length) < 0) {
    return {};
  }
  return {base, static_cast<unsigned>(address), static_cast<unsigned>(length)};
}

// All of a file, as the readers of this folder would read it. What cannot be read is no matter
// here: they say it. It ends at an object whose attributes HDF5 must not touch.
class Walk {
 public:
  explicit Walk(bool contents) : contents_(contents) {}

  void all(hid_t file, const std::string& name) {
    const Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
    if (!root.valid()) return;
    bytes_of_file_.open(name, std::ios::binary);
    format_ = format_of(file);
    group(root, 0);
  }
  bool out_of_memory() const { return out_of_memory_; }
  /// An attribute is larger than its place.
  bool damaged() const { return damaged_; }
  /// Size of all datasets met, as they claim.
  double bytes() const { return bytes_; }

 private:
  struct Below {
    Walk& walk;
    int depth;
  };

  void group(hid_t id, int depth) {
    attributes(id);
    if (damaged_) return;
    H5O_info_t info;
    if (H5Oget_info2(id, &info, H5O_INFO_BASIC) < 0) return failed();
    if (depth > kDeepest || !seen_.emplace(info.fileno, info.addr).second) return;
    Below below{*this, depth};
    if (H5Literate(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, link, &below) < 0) failed();
  }

  static herr_t link(hid_t group, const char* name, const H5L_info_t* info, void* data) {
    const auto [walk, depth] = *static_cast<Below*>(data);
    if (info->type != H5L_TYPE_HARD) return 0;
    const Handle object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
    if (!object.valid()) {
      walk.failed();
    } else if (H5Iget_type(object) == H5I_GROUP) {
      walk.group(object, depth + 1);
    } else if (H5Iget_type(object) == H5I_DATASET) {
      walk.dataset(object);
    }
    return walk.damaged_ ? 1 : 0;
  }

  static herr_t attribute(hid_t object, const char* name, const H5A_info_t*, void* data) {
    auto& walk = *static_cast<Walk*>(data);
    const Handle one(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(one), H5Tclose);
    const Handle space(H5Aget_space(one), H5Sclose);
    if (!one.valid() || !type.valid() || !space.valid()) {
      walk.failed();
      return 0;
    }
    const H5T_class_t kind = H5Tget_class(type);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    const std::size_t size = H5Tget_size(type);
    if (count != 1 || size > file_size(object)) return 0;
    if (kind == H5T_STRING && H5Tis_variable_str(type) <= 0) {
      walk.read(size, [&](void* to) { return H5Aread(one, type, to); });
    } else if (kind == H5T_INTEGER || kind == H5T_FLOAT) {
      walk.read(sizeof(double), [&](void* to) { return H5Aread(one, H5T_NATIVE_DOUBLE, to); });
    }
    return 0;
  }

  void attributes(hid_t id) {
    H5O_info_t info;
    if (H5Oget_info2(id, &info, H5O_INFO_BASIC) < 0) return failed();
    damaged_ = damaged_ || !attributes_fit(bytes_of_file_, format_, info.addr);
    if (damaged_) return;
    if (H5Aiterate2(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, attribute, this) < 0) failed();
  }

  void dataset(hid_t set) {
    attributes(set);
    if (damaged_) return;
    const Handle claimed(H5Dget_space(set), H5Sclose);
    bytes_ += kNumber * static_cast<double>(std::max<hssize_t>(
                            0, claimed.valid() ? H5Sget_simple_extent_npoints(claimed) : 0));
    if (!contents_) return;
    if (!unreadable(set).empty()) return failed();
    const Handle space(H5Dget_space(set), H5Sclose);
    const Handle type(H5Dget_type(set), H5Tclose);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (count < 0) return failed();
    const auto as = [&](hid_t native) {
      read(static_cast<std::size_t>(count) * H5Tget_size(native),
           [&](void* to) { return H5Dread(set, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, to); });
    };
    if (H5Tget_class(type) == H5T_FLOAT) return as(H5T_NATIVE_DOUBLE);
    as(H5Tget_size(type) == 1 ? H5T_NATIVE_CHAR : H5T_NATIVE_LLONG);
  }

  template <class Read>
  void read(std::size_t bytes, Read call) {
    void* to = std::malloc(std::max<std::size_t>(bytes, 1));
    if (to == nullptr) {
      out_of_memory_ = true;
      return;
    }
    if (call(to) < 0) failed();
    std::free(to);
  }

  void failed() { out_of_memory_ = out_of_memory_ || hdf5::out_of_memory(); }

  std::set<std::pair<unsigned long, haddr_t>> seen_;
  std::ifstream bytes_of_file_;
  AddressFormat format_;
  bool contents_, out_of_memory_ = false, damaged_ = false;
  double bytes_ = 0;
};

// False when it takes more memory than allowed. Throws std::invalid_argument when HDF5 must not
// touch the file.
bool go_through(const std::string& file, Walk& walk) {
  const Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!handle.valid()) return true;
  walk.all(handle, file);
  if (walk.damaged()) throw std::invalid_argument(file);
  return !walk.out_of_memory();
}

// Whether the user has limited our memory, so that want of it says nothing about the file.
bool memory_is_limited() {
  rlimit limit{};
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

std::string why(const ChildResult& result) {
  switch (result.end) {
    case ChildEnd::failed:
      return "reading it takes more memory than the file can need";
    case ChildEnd::refused:
      return "an attribute is larger than its place";
    case ChildEnd::endless:
      return "reading it does not come to an end";
    case ChildEnd::crashed:
      return "reading it crashes the HDF5 library" +
             (result.signal.empty() ? "" : fmt::format(" ({})", result.signal));
    case ChildEnd::ok:
    case ChildEnd::killed:
    case ChildEnd::unknown:  // there is no look ahead; the file is read as it is
      break;
  }
  return "";
}

}  // namespace

int StructureOnly::depth_ = 0;

double content_bytes(const std::string& file) {
  const StructureOnly alone;
  const Handle handle = open_for_reading(file);
  Walk walk(false);
  walk.all(handle, file);
  return walk.bytes();
}

void trust(const std::string& file) {
  State state;
  if (state_of(file, state)) known().insert(state);
}

void read_on_trial(const std::string& file) {
  State state;
  if (!state_of(file, state) || known().count(state) > 0) return;
  const bool alone = StructureOnly::holds();
  if (alone && known_structures().count(state) > 0) return;
  const auto size = static_cast<double>(std::get<2>(state));
  const ChildLimits limits =
      alone ? ChildLimits{kStructureSeconds, kStructureMemory, kStructureClock}
            : ChildLimits{kSeconds + size / kBytesPerSecond, kMemory + kMemoryShare * size};
  const ChildResult result = run_in_child(limits, [&] {
    Walk walk(!alone);
    return go_through(file, walk);
  });
  if (alone && (result.end == ChildEnd::endless || result.end == ChildEnd::failed)) {
    throw TooMuchToLookAt(
        fmt::format("{}: takes longer to look through, or more memory, than a check has", file));
  }
  if (result.end == ChildEnd::killed || (result.end == ChildEnd::failed && memory_is_limited())) {
    throw CannotReadNow(fmt::format("{}: cannot be read now: {}", file,
                                    result.end == ChildEnd::killed
                                        ? "a look at it was killed, perhaps for want of memory"
                                        : std::strerror(ENOMEM)));
  }
  if (const std::string problem = why(result); !problem.empty()) {
    throw std::invalid_argument(fmt::format("{}: damaged: {}", file, problem));
  }
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (nanoseconds(now) - std::get<3>(state) > kYoung) {
    (alone ? known_structures() : known()).insert(state);
  }
}

}  // namespace grainfield::dem::hdf5
