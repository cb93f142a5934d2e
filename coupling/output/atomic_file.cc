#include "coupling/output/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "dem/snapshot/replace_file.h"
#include "dem/storage_failed.h"

namespace grainfield::coupling {

namespace fs = std::filesystem;

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  static std::atomic<unsigned> counter{0};
  const fs::path target(path_);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw std::invalid_argument(
        fmt::format("cannot write {}: {} is not a folder", path_, folder.string()));
  if (fs::is_directory(target, error))
    throw std::invalid_argument(fmt::format("cannot write {}: it is a folder", path_));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw std::invalid_argument(
        fmt::format("cannot write {}: no permission to write in {}", path_, folder.string()));
  temporary_ =
      (folder / fmt::format(".{}.{}.{}.part", target.filename().string(), getpid(), counter++))
          .string();
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  dem::replace_file(temporary_, path_);
  committed_ = true;
}

void write_text_file(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  std::ofstream out(file.temporary(), std::ios::binary);
  out << text;
  out.close();
  if (!out) throw dem::StorageFailed(fmt::format("cannot write {}: disk full?", path));
  file.commit();
}

std::string read_text_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace grainfield::coupling
