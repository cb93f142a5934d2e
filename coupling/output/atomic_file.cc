#include "coupling/output/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "dem/snapshot/replace_file.h"
#include "dem/storage_failed.h"

namespace grainfield::coupling {

namespace fs = std::filesystem;

namespace {

constexpr int kMostLinks = 40;            // as Linux follows
constexpr std::size_t kLongestName = 60;  // of the target's own name in the temporary one

// What the links lead to, there or not.
fs::path behind_links(fs::path path, const std::string& given) {
  std::error_code error;
  for (int k = 0; fs::is_symlink(fs::symlink_status(path, error)); ++k) {
    if (k == kMostLinks) {
      throw std::invalid_argument(fmt::format("cannot write {}: a circle of links", given));
    }
    const fs::path next = fs::read_symlink(path, error);
    if (error) break;
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return path;
}

const char* kind_of(fs::file_type type) {
  switch (type) {
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::character:
    case fs::file_type::block:
      return "a device";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    default:
      return "no regular file";
  }
}

std::string random_word() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  std::error_code error;
  const fs::file_status there = fs::status(path_, error);
  if (there.type() == fs::file_type::none) {
    throw std::invalid_argument(fmt::format("cannot write {}: {}", path_, error.message()));
  }
  if (fs::exists(there) && !fs::is_regular_file(there)) {
    throw std::invalid_argument(
        fmt::format("cannot write {}: it is {}", path_, kind_of(there.type())));
  }
  const fs::path target = behind_links(path_, path_);
  target_ = target.string();
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    throw std::invalid_argument(
        fmt::format("cannot write {}: {} is not a folder", path_, folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw std::invalid_argument(
        fmt::format("cannot write {}: no permission to write in {}", path_, folder.string()));
  temporary_ =
      (folder / fmt::format(".{}.{}.part", target.filename().string().substr(0, kLongestName),
                            random_word()))
          .string();
  undo_ = std::make_unique<OnSignal>([file = temporary_] {
    std::error_code ignored;
    fs::remove(file, ignored);
  });
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

void AtomicFile::write(const std::string& text) const {
  errno = 0;
  std::ofstream out(temporary_, std::ios::binary);
  out << text;
  out.close();
  if (!out) {
    throw dem::StorageFailed(fmt::format("cannot write {}: {}", path_,
                                         errno != 0 ? std::strerror(errno) : "is the disk full?"));
  }
}

void AtomicFile::commit() {
  std::error_code error;
  const fs::file_status there = fs::status(target_, error);
  if (fs::exists(there)) fs::permissions(temporary_, there.permissions(), error);
  dem::replace_file(temporary_, target_);
  committed_ = true;
}

void write_text_file(const std::string& path, const std::string& text) {
  write_text_files({{path, text}});
}

void write_text_files(const std::vector<std::pair<std::string, std::string>>& files) {
  std::vector<std::unique_ptr<AtomicFile>> written;
  for (const auto& [path, text] : files) {
    written.push_back(std::make_unique<AtomicFile>(path));
    written.back()->write(text);
  }
  const HeldSignals held;
  for (const auto& file : written) file->commit();
}

std::string read_text_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace grainfield::coupling
