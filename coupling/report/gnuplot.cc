#include "coupling/report/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <vector>

#include "coupling/system/signals.h"

extern char** environ;

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kTries = 5;  // of a picture whose drawing a signal ended

/// A file in memory without a name: what a child reads or writes, and nobody else finds.
class MemoryFile {
 public:
  explicit MemoryFile(const char* what) : descriptor_(memfd_create(what, MFD_CLOEXEC)) {
    if (descriptor_ < 0) {
      throw std::runtime_error(fmt::format("cannot pass on {}: {}", what, std::strerror(errno)));
    }
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  int descriptor() const { return descriptor_; }

  void put(const std::string& text) {
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t n = write(descriptor_, text.data() + done, text.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw std::runtime_error("cannot pass on a plot program: out of memory?");
      done += static_cast<std::size_t>(n);
    }
  }
  std::string text() const {
    std::string out;
    char block[65536];
    for (off_t at = 0;;) {
      const ssize_t n = pread(descriptor_, block, sizeof block, at);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return out;
      out.append(block, static_cast<std::size_t>(n));
      at += n;
    }
  }

 private:
  int descriptor_;
};

// Ours without what steers gnuplot (GNUTERM is a command to it) and with a language that is there.
std::vector<std::string> environment() {
  std::vector<std::string> out{"LC_ALL=C.UTF-8"};
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    if (!text.starts_with("GNU") && !text.starts_with("LC_") && !text.starts_with("LANG")) {
      out.emplace_back(text);
    }
  }
  return out;
}

// gnuplot in a process group of its own: Ctrl-C on the terminal is meant for us, who decide what
// becomes of the picture. It starts with the signals as they are by default.
pid_t start(const std::string& program, const MemoryFile& script, const MemoryFile& picture,
            const MemoryFile& messages) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, script.descriptor(), 0);
  posix_spawn_file_actions_adddup2(&files, picture.descriptor(), 1);
  posix_spawn_file_actions_adddup2(&files, messages.descriptor(), 2);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, standard;
  sigemptyset(&none);
  sigemptyset(&standard);
  for (const int number : {SIGPIPE, SIGXFSZ}) sigaddset(&standard, number);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &standard);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  // Without the user's own settings of gnuplot. /dev/stdin as a file to load: an error ends
  // gnuplot, as it would not in a dialogue.
  std::string path = program, plain = "--default-settings", argument = "/dev/stdin";
  char* arguments[] = {path.data(), plain.data(), argument.data(), nullptr};
  std::vector<std::string> variables = environment();
  std::vector<char*> names;
  for (std::string& variable : variables) names.push_back(variable.data());
  names.push_back(nullptr);
  pid_t child = -1;
  const int failed =
      posix_spawn(&child, program.c_str(), &files, &attributes, arguments, names.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) {
    throw std::runtime_error(fmt::format("cannot start {}: {}", program, std::strerror(failed)));
  }
  return child;
}

constexpr int kSignal = 128;  // added to the signal that ended a child

// Exit status, -1 after the time limit, or kSignal + the signal that ended it.
int wait_for(pid_t child, double seconds) {
  const OnSignal end_it([child] { kill(child, SIGKILL); });
  const auto limit = Clock::now() + std::chrono::duration<double>(seconds);
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (Clock::now() > limit) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return -1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kSignal + WTERMSIG(status);
}

}  // namespace

std::optional<std::string> find_gnuplot() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (folder.empty()) continue;
    const std::string candidate = (fs::path(folder) / "gnuplot").string();
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored) && access(candidate.c_str(), X_OK) == 0)
      return candidate;
  }
  return std::nullopt;
}

Drawing draw(const std::string& gnuplot, const std::string& terminal, const std::string& program,
             double seconds) {
  MemoryFile script("a plot program");
  script.put("set terminal " + terminal + "\nset output\n" + program + "\nunset output\n");
  Drawing result;
  std::string said;
  int status = 0;
  // A signal to our group may meet gnuplot before it has left the group.
  for (int k = 0; k < kTries; ++k) {
    const MemoryFile picture("a picture"), messages("gnuplot's messages");
    status = wait_for(start(gnuplot, script, picture, messages), seconds);
    if (status == 0) result.bytes = picture.text();
    said = messages.text();
    if (status < kSignal) break;
  }
  if (!result.bytes.empty()) return result;
  if (status == -1) {
    result.error = fmt::format("gnuplot took longer than {:g} s", seconds);
    return result;
  }
  // gnuplot shows the line, a caret, and then the message.
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);)
    if (line.find("/dev/stdin") != std::string::npos && line.find("line ") != std::string::npos)
      result.error = line.substr(line.find("line "));
  if (result.error.empty()) result.error = fmt::format("gnuplot ended with status {}", status);
  return result;
}

}  // namespace grainfield::coupling
