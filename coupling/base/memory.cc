#include "coupling/base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "dem/shared/number.h"

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// The number in such a file; "max" and no file are no limit.
double number_in(const fs::path& file) {
  std::ifstream in(file);
  std::string text;
  in >> text;
  const double bytes = parse_number(text).value_or(0);
  return bytes > 0 ? bytes : kUnlimited;
}

// The least limit of this process's control group and all above it.
double group_limit() {
  double least = number_in("/sys/fs/cgroup/memory/memory.limit_in_bytes");  // version 1
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    constexpr const char* kVersion2 = "0::";
    if (!line.starts_with(kVersion2)) continue;
    const fs::path root = "/sys/fs/cgroup";
    fs::path group = root / fs::path(line.substr(3)).relative_path();
    for (;; group = group.parent_path()) {
      least = std::min(least, number_in(group / "memory.max"));
      if (group == root || !group.has_relative_path()) break;
    }
  }
  return least;
}

}  // namespace

double memory_limit() {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  double least =
      pages > 0 && page > 0 ? static_cast<double>(pages) * static_cast<double>(page) : kUnlimited;
  least = std::min(least, group_limit());
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) {
    least = std::min(least, static_cast<double>(space.rlim_cur));
  }
  return least;
}

}  // namespace grainfield::coupling
