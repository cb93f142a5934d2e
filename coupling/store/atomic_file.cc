#include "coupling/store/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "dem/hdf5/replace_file.h"
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

// A mark of this host, 16 bits.
unsigned host_mark() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return 0;
  unsigned hash = 0x811c9dc5U;  // FNV-1a
  for (const char* at = name.data(); *at != '\0'; ++at) {
    hash = (hash ^ static_cast<unsigned char>(*at)) * 0x01000193U;
  }
  return (hash ^ hash >> 16) & 0xffffU;
}

// 16 hexadecimal digits: the process, its host, and chance.
std::string own_word() {
  std::random_device device;
  return fmt::format("{:08x}{:04x}{:04x}", static_cast<unsigned>(getpid()), host_mark(),
                     device() & 0xffffU);
}

// Whether this is the name of a temporary file whose process was ours and is no more.
bool is_orphan(const std::string& name) {
  constexpr std::string_view kPart = ".part";
  constexpr std::size_t kWord = 16;
  if (!name.starts_with('.') || !name.ends_with(kPart)) return false;
  const std::string_view rest = std::string_view(name).substr(0, name.size() - kPart.size());
  if (rest.size() < kWord + 3 || rest[rest.size() - kWord - 1] != '.') return false;
  const std::string_view word = rest.substr(rest.size() - kWord);
  unsigned process = 0, host = 0;
  const auto hex = [](std::string_view digits, unsigned& number) {
    const char* const end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, number, 16);
    return error == std::errc() && stop == end;
  };
  if (!hex(word.substr(0, 8), process) || !hex(word.substr(8, 4), host)) return false;
  const auto pid = static_cast<pid_t>(process);
  return host == host_mark() && pid > 0 && kill(pid, 0) != 0 && errno == ESRCH;
}

}  // namespace

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
      return "a file";
  }
}

void remove_orphans(const std::string& folder) {
  std::error_code error;
  std::vector<fs::path> orphans;
  for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    if (is_orphan(at->path().filename().string()) &&
        fs::is_regular_file(at->symlink_status(error))) {
      orphans.push_back(at->path());
    }
  }
  for (const fs::path& orphan : orphans) fs::remove(orphan, error);
}

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
      (folder /
       fmt::format(".{}.{}.part", target.filename().string().substr(0, kLongestName), own_word()))
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
  std::ofstream out;
  errno = 0;
  unless_stopping([&] { out.open(temporary_, std::ios::binary); });
  out << text;
  out.close();
  if (!out) {
    throw dem::StorageFailed(fmt::format("cannot write {}: {}", dem::final_name(path_),
                                         errno != 0 ? std::strerror(errno) : "is the disk full?"));
  }
}

void AtomicFile::write_with(const std::function<void(const std::string&)>& work) const {
  unless_stopping([&] { work(temporary_); });
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
  std::error_code error;
  const fs::file_status there = fs::status(path, error);
  if (there.type() == fs::file_type::not_found) return "";
  if (fs::exists(there) && !fs::is_regular_file(there)) {
    throw std::invalid_argument(
        fmt::format("{}: is {}, expected a file", path, kind_of(there.type())));
  }
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  if (in.peek() != std::ifstream::traits_type::eof()) out << in.rdbuf();
  if (!in.is_open() || in.bad()) {
    throw std::invalid_argument(
        fmt::format("{}: cannot be read now: {}", path, std::strerror(errno != 0 ? errno : EIO)));
  }
  return out.str();
}

}  // namespace grainfield::coupling
