#include "coupling/base/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "coupling/base/printable.h"
#include "dem/shared/number.h"
#include "dem/storage_failed.h"

namespace grainfield::coupling {

using namespace std::chrono_literals;

namespace {

constexpr std::size_t kLongestCommand = 200;  // bytes of it that the file keeps
// How long a lock is asked for whose holder is dead, or may be ending just now: a child of a killed
// process has it until it ends too.
constexpr std::chrono::milliseconds kForTheDead = 10s, kForTheLiving = 300ms, kPause = 10ms;

struct Holder {
  long process = 0;
  std::string host, command;
};

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

// "PROCESS HOST COMMAND"; process 0 where the file says nothing.
Holder read_holder(int descriptor) {
  std::array<char, 1024> text{};
  const ssize_t n = pread(descriptor, text.data(), text.size() - 1, 0);
  std::istringstream in(std::string(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0));
  Holder out;
  std::string process;
  if (in >> process >> out.host) std::getline(in >> std::ws, out.command);
  out.process = parse_integer(process).value_or(0);
  return out;
}

bool lives(const Holder& holder) {
  if (holder.process <= 0) return false;
  if (holder.host != host_name()) return true;
  return kill(static_cast<pid_t>(holder.process), 0) == 0 || errno == EPERM;
}

// Whether the open file is still the one of this name.
bool same_file(int descriptor, const std::string& file) {
  struct stat open_one = {}, named = {};
  return fstat(descriptor, &open_one) == 0 && stat(file.c_str(), &named) == 0 &&
         open_one.st_dev == named.st_dev && open_one.st_ino == named.st_ino;
}

}  // namespace

FileLock::FileLock(const std::string& file, const std::string& what, const std::string& hint,
                   const std::string& command)
    : file_(file) {
  const auto begin = std::chrono::steady_clock::now();
  while (descriptor_ < 0) {
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor < 0) {
      const std::error_code error(errno, std::generic_category());
      const std::string why = fmt::format("{}: cannot write {}: {}", what, file, error.message());
      if (dem::means_storage_failed(error)) throw dem::StorageFailed(why);
      throw std::invalid_argument(why);
    }
    struct stat is = {};
    if (fstat(descriptor, &is) == 0 && !S_ISREG(is.st_mode)) {
      close(descriptor);
      throw std::invalid_argument(fmt::format(
          "{}: {} is a pipe or a device, expected a file of grainfield's; remove it", what, file));
    }
    const bool locked = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    const bool known = locked || errno == EWOULDBLOCK;
    const Holder holder = read_holder(descriptor);
    const bool alive = lives(holder);
    const bool ours = known ? locked : !alive;
    // A holder that ends between our open and our lock takes its file along.
    if (ours && same_file(descriptor, file)) {
      descriptor_ = descriptor;
      break;
    }
    close(descriptor);
    const auto waited = std::chrono::steady_clock::now() - begin;
    if (!ours && waited > (alive ? kForTheLiving : kForTheDead)) {
      // Where the holder's word is all there is, nobody else can tell that it has ended.
      const std::string word =
          known ? ""
                : fmt::format(" (this file system has no locks: if nobody works there, remove {})",
                              file);
      throw std::invalid_argument(
          fmt::format("{}: in use by {}; {}{}", what,
                      alive ? fmt::format("process {} on {} ({})", holder.process,
                                          one_line(holder.host, kLongestCommand),
                                          one_line(holder.command, kLongestCommand))
                            : "another process, which has not yet said its name",
                      hint, word));
    }
    if (!ours) std::this_thread::sleep_for(kPause);
  }
  const std::string text =
      fmt::format("{} {} {}\n", getpid(), host_name(), one_line(command, kLongestCommand));
  if (ftruncate(descriptor_, 0) != 0 ||
      pwrite(descriptor_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
    const std::string why = std::strerror(errno);
    unlink(file_.c_str());
    close(descriptor_);
    throw dem::StorageFailed(fmt::format("{}: cannot write {}: {}", what, file, why));
  }
}

FileLock::~FileLock() {
  // First the name, then the lock: whoever opens the name in between finds that it is another file.
  unlink(file_.c_str());
  close(descriptor_);
}

}  // namespace grainfield::coupling
