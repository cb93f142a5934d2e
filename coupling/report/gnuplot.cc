#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "coupling/base/signals.h"
#include "coupling/report/drawing.h"

extern char** environ;

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kTries = 5;  // of a picture whose drawing a signal ended

/// A pipe between us and a child: no file, so that neither a disk nor a limit on files matters.
class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) {
      throw std::runtime_error(fmt::format("cannot talk to gnuplot: {}", std::strerror(errno)));
    }
  }
  ~Pipe() {
    shut(0);
    shut(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int reading() const { return ends_[0]; }
  int writing() const { return ends_[1]; }
  void shut_reading() { shut(0); }
  void shut_writing() { shut(1); }

 private:
  void shut(std::size_t end) {
    if (ends_[end] >= 0) close(ends_[end]);
    ends_[end] = -1;
  }
  std::array<int, 2> ends_{-1, -1};
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
pid_t start(const std::string& program, const Pipe& script, const Pipe& picture,
            const Pipe& messages) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, script.reading(), 0);
  posix_spawn_file_actions_adddup2(&files, picture.writing(), 1);
  posix_spawn_file_actions_adddup2(&files, messages.writing(), 2);
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

constexpr int kSignal = 128;        // added to the signal that ended a child
constexpr int kTooLong = -1;        // instead of an exit status
constexpr int kPoll = 5;            // ms
constexpr double kLastWords = 0.1;  // s, for what a child that has ended left in its pipes

struct Reply {
  int status = 0;  ///< exit status, kTooLong, or kSignal + the signal that ended it
  std::string picture, messages;
};

// What is there now; false when nothing more will come.
bool take(int from, std::string& to) {
  std::array<char, 65536> block{};
  while (true) {
    const ssize_t n = read(from, block.data(), block.size());
    if (n > 0) {
      to.append(block.data(), static_cast<std::size_t>(n));
    } else {
      return n < 0 && (errno == EAGAIN || errno == EINTR);
    }
  }
}

// As write(), but a reader that has gone is an error (EPIPE) and not a signal, whatever the process
// does with SIGPIPE.
ssize_t write_to_reader(int to, const char* data, std::size_t size) {
  sigset_t pipe_signal, before;
  sigemptyset(&pipe_signal);
  sigaddset(&pipe_signal, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
  const ssize_t n = write(to, data, size);
  const int why = errno;
  if (n < 0 && why == EPIPE) {
    const timespec at_once{};
    sigtimedwait(&pipe_signal, nullptr, &at_once);
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = why;
  return n;
}

// gnuplot reads, draws and complains at the same time.
Reply converse(const std::string& program, const std::string& text, double seconds) {
  Pipe script, picture, messages;
  for (const int ours : {script.writing(), picture.reading(), messages.reading()}) {
    fcntl(ours, F_SETFL, O_NONBLOCK);
  }
  const pid_t child = start(program, script, picture, messages);
  const OnSignal end_it([child] { kill(child, SIGKILL); });
  script.shut_reading();
  picture.shut_writing();
  messages.shut_writing();
  Reply answer;
  std::size_t given = 0;
  auto limit = Clock::now() + std::chrono::duration<double>(seconds);
  bool drawing = true, talking = true, ended = false;
  while (drawing || talking || !ended) {
    if (given == text.size()) script.shut_writing();
    std::array<pollfd, 3> ready{{{script.writing(), POLLOUT, 0},
                                 {drawing ? picture.reading() : -1, POLLIN, 0},
                                 {talking ? messages.reading() : -1, POLLIN, 0}}};
    poll(ready.data(), ready.size(), kPoll);
    if (ready[0].revents != 0) {
      const ssize_t n = write_to_reader(script.writing(), text.data() + given, text.size() - given);
      if (n > 0) given += static_cast<std::size_t>(n);
      // It has stopped reading: an error, about which it says more than we could.
      if (n < 0 && errno != EAGAIN && errno != EINTR) given = text.size();
    }
    if (ready[1].revents != 0) drawing = take(picture.reading(), answer.picture);
    if (ready[2].revents != 0) talking = take(messages.reading(), answer.messages);
    if (!ended) {
      int status = 0;
      ended = waitpid(child, &status, WNOHANG) == child;
      if (ended) {
        answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : kSignal + WTERMSIG(status);
        limit = std::min(limit, Clock::now() + std::chrono::duration<double>(kLastWords));
      }
    }
    if (Clock::now() <= limit) continue;
    if (ended) break;  // something that it started holds the pipes
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    answer.status = kTooLong;
    break;
  }
  return answer;
}

// A signal to our group may meet gnuplot before it has left the group. What else ends it, such as a
// crash or want of memory, would end it again.
bool was_meant_for_us(int status) {
  return status == kSignal + SIGINT || status == kSignal + SIGTERM || status == kSignal + SIGHUP ||
         status == kSignal + SIGQUIT;
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
  const std::string text =
      "set terminal " + terminal + "\nset output\n" + program + "\nunset output\n";
  Drawing result;
  Reply answer;
  for (int k = 0; k < kTries; ++k) {
    answer = converse(gnuplot, text, seconds);
    if (!was_meant_for_us(answer.status)) break;
  }
  if (answer.status == 0 && !answer.picture.empty()) {
    result.bytes = std::move(answer.picture);
    return result;
  }
  if (answer.status == kTooLong) {
    result.error = fmt::format("gnuplot took longer than {:g} s", seconds);
    return result;
  }
  // gnuplot shows the line, a caret, and then the message.
  std::istringstream lines(answer.messages);
  for (std::string line; std::getline(lines, line);)
    if (line.find("/dev/stdin") != std::string::npos && line.find("line ") != std::string::npos)
      result.error = line.substr(line.find("line "));
  if (!result.error.empty()) return result;
  const int number = answer.status - kSignal;
  const char* name = number > 0 ? sigabbrev_np(number) : nullptr;
  result.error = name != nullptr ? fmt::format("SIG{} ended gnuplot", name)
                                 : fmt::format("gnuplot ended with status {}", answer.status);
  return result;
}

}  // namespace grainfield::coupling
