#include "coupling/base/read_input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>

#include "coupling/base/printable.h"
#include "dem/shared/refuse.h"

namespace grainfield::coupling {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kForAWriter = 2;  // s until somebody must have opened a pipe for writing
constexpr int kPause = 20;         // ms

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

const char* kind(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISSOCK(mode)) return "a socket";
  if (S_ISFIFO(mode)) return "a pipe";
  return "a device";
}

class Descriptor {
 public:
  explicit Descriptor(const std::string& file)
      : number_(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  operator int() const { return number_; }

 private:
  int number_;
};

// True when there is something to read, or the writers have gone.
bool ready(int descriptor, int milliseconds) {
  pollfd wanted{descriptor, POLLIN, 0};
  return poll(&wanted, 1, milliseconds) > 0 && wanted.revents != 0;
}

}  // namespace

std::string read_input(const std::string& file, const std::string& expected,
                       const InputLimits& limits) {
  struct stat is {};
  if (stat(file.c_str(), &is) != 0) {
    refuse(file, errno == ENOENT || errno == ENOTDIR
                     ? "no such file"
                     : fmt::format("cannot be read: {}", std::strerror(errno)));
  }
  if (S_ISDIR(is.st_mode) || S_ISSOCK(is.st_mode) || S_ISBLK(is.st_mode)) {
    refuse(file, fmt::format("is {}, expected {}", kind(is.st_mode), expected));
  }
  const Descriptor in(file);
  // What was looked at may have been replaced since.
  if (in < 0 || fstat(in, &is) != 0) {
    refuse(file, fmt::format("cannot be read: {}", std::strerror(errno)));
  }
  const bool regular = S_ISREG(is.st_mode);
  const auto start = Clock::now();
  bool told = false;
  std::string text;
  std::array<char, 65536> block{};
  while (text.size() <= limits.bytes) {
    const ssize_t n = read(in, block.data(), block.size());
    if (n > 0 && S_ISCHR(is.st_mode) && isatty(in) == 0) {  // one that never ends
      refuse(file, fmt::format("is {}, expected {}", kind(is.st_mode), expected));
    } else if (n > 0) {
      text.append(block.data(), static_cast<std::size_t>(n));
    } else if (n < 0 && errno == EINTR) {
      continue;
    } else if (n < 0 && errno != EAGAIN) {
      refuse(file, fmt::format("cannot be read: {}", std::strerror(errno)));
    } else if (n == 0 && (!S_ISFIFO(is.st_mode) || !text.empty() || ready(in, 0))) {
      break;
    } else if (n == 0) {  // nobody has opened it for writing
      if (seconds_since(start) > kForAWriter) {
        refuse(file, fmt::format("is a pipe that nobody writes to, expected {}", expected));
      }
      poll(nullptr, 0, kPause);
    } else {
      ready(in, kPause);
    }
    if (!regular && limits.seconds == 0 && !told && text.empty() &&
        seconds_since(start) > kForAWriter) {
      told = true;
      fmt::print(stderr, "grainfield: waiting for what is written to {}\n", printable(file));
    }
    if (!regular && limits.seconds > 0 && seconds_since(start) > limits.seconds) {
      refuse(file, fmt::format("is {} that does not come to its end within {:g} s, expected {}",
                               kind(is.st_mode), limits.seconds, expected));
    }
  }
  if (text.size() > limits.bytes) text.resize(limits.bytes + 1);
  return text;
}

void require_regular_file(const std::string& file, const std::string& expected) {
  struct stat is {};
  if (stat(file.c_str(), &is) != 0 || S_ISREG(is.st_mode)) return;
  refuse(file, fmt::format("is {}, expected {}", kind(is.st_mode), expected));
}

}  // namespace grainfield::coupling
