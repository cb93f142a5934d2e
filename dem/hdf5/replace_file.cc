#include "dem/hdf5/replace_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>

#include "dem/storage_failed.h"

namespace grainfield::dem {
namespace {

namespace fs = std::filesystem;

// Waits until all of it is on the disk. File systems that cannot tell (EINVAL), and folders that
// may be written but not read, are taken as they are.
void flush(const std::string& path, int flags, const std::string& target) {
  const int file = open(path.c_str(), flags | O_RDONLY | O_CLOEXEC);
  int failed = file < 0 ? errno : 0;
  if (file >= 0) {
    if (fsync(file) != 0) failed = errno;
    close(file);
  }
  const std::error_code error(failed, std::generic_category());
  if (means_storage_failed(error) && failed != EROFS) {
    throw StorageFailed(
        fmt::format("{}: cannot be written to its end: {}", final_name(target), error.message()));
  }
}

}  // namespace

std::string final_name(const std::string& path) {
  constexpr std::string_view kPart = ".part";
  constexpr std::size_t kWord = 17;  // a dot and 16 hexadecimal digits
  fs::path out;
  for (const fs::path& step : fs::path(path)) {
    if (step != ".partial") out /= step;
  }
  std::string name = out.filename().string();
  if (!name.ends_with(kPart)) return out.string();
  name.resize(name.size() - kPart.size());
  if (name.starts_with('.') && name.size() > kWord + 1 && name[name.size() - kWord] == '.') {
    name = name.substr(1, name.size() - kWord - 1);
  }
  return out.replace_filename(name).string();
}

void replace_file(const std::string& beside, const std::string& target) {
  flush(beside, 0, target);
  std::error_code error;
  fs::rename(beside, target, error);
  if (error) {
    throw StorageFailed(
        fmt::format("{}: cannot take its place: {}", final_name(target), error.message()));
  }
  const std::string folder = fs::path(target).parent_path().string();
  flush(folder.empty() ? "." : folder, O_DIRECTORY, target);
}

}  // namespace grainfield::dem
