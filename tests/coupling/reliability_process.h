// Starts the real program as a hostile surrounding does: in a process group of its own, with
// streams that cannot be written, under limits, and ended by signals.
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <functional>
#include <set>
#include <thread>
#include <vector>

#include "program.h"

extern char** environ;

namespace grainfield::coupling::testing {

/// Where a stream of the program goes: read by the test, /dev/full, closed, a pipe that nobody
/// reads any more, or the end of a file.
enum class Stream { collected, full, closed, broken, file };

inline const char* name_of(Stream stream) {
  constexpr std::array kNames{"collected", "full", "closed", "broken", "file"};
  return kNames[static_cast<std::size_t>(stream)];
}

struct Start {
  std::vector<std::string> words;                  ///< after the program's name
  std::vector<std::string> before = {};            ///< what starts it, such as nohup
  std::string folder = "";                         ///< where it works; "": where the test works
  std::map<std::string, std::string> environment;  ///< beside the test's own
  Stream out = Stream::collected, err = Stream::collected;
  std::string out_file = "";         ///< of Stream::file
  rlim_t file_size = RLIM_INFINITY;  ///< most bytes of a file that it writes
};

struct Ending {
  int code = -1;      ///< exit code, -1 where a signal ended it
  int signal = 0;     ///< that ended it
  bool late = false;  ///< it had to be killed at the time limit
  std::string out, err;
};

inline std::ostream& operator<<(std::ostream& out, const Ending& ending) {
  out << (ending.late ? "killed at the time limit" : "");
  if (ending.signal != 0) out << "signal " << ending.signal;
  return out << " exit code " << ending.code << "\n" << ending.err;
}

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

inline void sleep_for(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Generous: the machine may be busy with other suites. s
constexpr double kPatience = 240;

class Child {
 public:
  explicit Child(const Start& start) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    if (!start.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, start.folder.c_str());
    std::vector<int> ours;
    out_ = redirect(actions, STDOUT_FILENO, start.out, start.out_file, ours);
    err_ = redirect(actions, STDERR_FILENO, start.err, "", ours);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(
        &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setpgroup(&attributes, 0);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setsigmask(&attributes, &none);
    std::vector<std::string> words = start.before;
    words.emplace_back(GRAINFIELD_PROGRAM);
    words.insert(words.end(), start.words.begin(), start.words.end());
    std::vector<std::string> settings;
    for (char** at = environ; *at != nullptr; ++at) {
      const std::string text = *at;
      if (start.environment.count(text.substr(0, text.find('='))) == 0) settings.push_back(text);
    }
    for (const auto& [name, value] : start.environment) settings.push_back(name + "=" + value);
    // The child inherits the soft limit; the test itself writes nothing meanwhile.
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    rlimit during = before;
    during.rlim_cur = std::min(start.file_size, before.rlim_max);
    setrlimit(RLIMIT_FSIZE, &during);
    const int failed = posix_spawnp(&pid_, words.front().c_str(), &actions, &attributes,
                                    pointers(words).data(), pointers(settings).data());
    setrlimit(RLIMIT_FSIZE, &before);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    for (const int descriptor : ours) close(descriptor);
    if (failed != 0) throw std::runtime_error("cannot start " + words.front());
  }
  ~Child() {
    // Whatever it left behind in its group goes too.
    kill(-pid_, SIGKILL);
    if (!ended_) waitpid(pid_, nullptr, 0);
    for (const int descriptor : {out_, err_}) {
      if (descriptor >= 0) close(descriptor);
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  void send(int signal) { kill(pid_, signal); }
  void send_group(int signal) { kill(-pid_, signal); }

  bool running() {
    if (!ended_) {
      int status = 0;
      ended_ = waitpid(pid_, &status, WNOHANG) == pid_;
      if (ended_) take(status);
    }
    drain(out_, ending_.out);
    drain(err_, ending_.err);
    return !ended_;
  }

  /// What it said on stderr so far.
  const std::string& err() {
    running();
    return ending_.err;
  }

  /// Until it ends; after the limit it is killed with its group.
  Ending wait(double seconds = kPatience) {
    const auto start = std::chrono::steady_clock::now();
    while (running()) {
      if (seconds_since(start) > seconds && !ending_.late) {
        ending_.late = true;
        send_group(SIGKILL);
      }
      sleep_for(0.001);
    }
    return ending_;
  }

  /// Until it holds or the child has ended; true where it holds.
  bool wait_until(const std::function<bool()>& holds, double seconds = kPatience) {
    const auto start = std::chrono::steady_clock::now();
    while (running() && seconds_since(start) < seconds) {
      if (holds()) return true;
      sleep_for(0.0005);
    }
    return holds();
  }

  /// True once it has a handler for the signal (Linux: SigCgt of /proc/PID/status).
  bool catches(int signal) const {
    std::istringstream lines(read_text("/proc/" + std::to_string(pid_) + "/status"));
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("SigCgt:", 0) == 0)
        return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1U) != 0;
    }
    return false;
  }

 private:
  static std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> out;
    for (std::string& text : texts) out.push_back(text.data());
    out.push_back(nullptr);
    return out;
  }

  // The end that the test reads, -1 without. `ours` are closed once the child runs.
  static int redirect(posix_spawn_file_actions_t& actions, int to, Stream stream,
                      const std::string& file, std::vector<int>& ours) {
    if (stream == Stream::full) {
      posix_spawn_file_actions_addopen(&actions, to, "/dev/full", O_WRONLY, 0);
    } else if (stream == Stream::closed) {
      posix_spawn_file_actions_addclose(&actions, to);
    } else if (stream == Stream::file) {
      posix_spawn_file_actions_addopen(&actions, to, file.c_str(), O_WRONLY | O_CREAT | O_APPEND,
                                       0644);
    } else {
      std::array<int, 2> ends{};
      if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
      posix_spawn_file_actions_adddup2(&actions, ends[1], to);
      ours.push_back(ends[1]);
      if (stream == Stream::broken) {
        close(ends[0]);
      } else {
        fcntl(ends[0], F_SETFL, O_NONBLOCK);
        return ends[0];
      }
    }
    return -1;
  }

  static void drain(int descriptor, std::string& text) {
    std::array<char, 4096> block{};
    ssize_t size = 0;
    while (descriptor >= 0 && (size = read(descriptor, block.data(), block.size())) > 0)
      text.append(block.data(), static_cast<std::size_t>(size));
  }

  void take(int status) {
    if (WIFEXITED(status)) ending_.code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) ending_.signal = WTERMSIG(status);
  }

  pid_t pid_ = -1;
  int out_ = -1, err_ = -1;
  bool ended_ = false;
  Ending ending_;
};

inline Ending finish(const Start& start, double seconds = kPatience) {
  return Child(start).wait(seconds);
}

/// Lines of stderr that say why the program ended: "grainfield: ..." without warnings.
inline std::vector<std::string> complaints(const std::string& err) {
  std::vector<std::string> out;
  std::istringstream lines(err);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("grainfield: ", 0) == 0 && line.rfind("grainfield: warning: ", 0) != 0)
      out.push_back(line);
  }
  return out;
}

}  // namespace grainfield::coupling::testing
