#include "coupling/report/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "coupling/output/atomic_file.h"

extern char** environ;

namespace grainfield::coupling {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// A folder that goes with its object.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "grainfield-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw std::runtime_error(fmt::format("cannot make a temporary folder {}", name));
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

// Exit status, or -1 after the time limit.
int run(const std::string& program, const std::string& script, const std::string& messages,
        double seconds) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, messages.c_str(), O_WRONLY | O_CREAT, 0600);
  std::string path = program, argument = script;
  char* arguments[] = {path.data(), argument.data(), nullptr};
  pid_t child = -1;
  const int failed = posix_spawn(&child, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error(fmt::format("cannot start {}", program));
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
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
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
  const Folder folder;
  const std::string script = folder.file("picture.gp"), output = folder.file("picture"),
                    messages = folder.file("messages");
  {
    std::ofstream out(script);
    out << "set terminal " << terminal << "\nset output '" << output << "'\n"
        << program << "\nunset output\n";
    if (!out.flush()) throw std::runtime_error("cannot write the plot program: disk full?");
  }
  const int status = run(gnuplot, script, messages, seconds);
  Drawing result;
  if (status == 0) result.bytes = read_text_file(output);
  if (!result.bytes.empty()) return result;
  if (status == -1) {
    result.error = fmt::format("gnuplot took longer than {:g} s", seconds);
    return result;
  }
  // gnuplot shows the line, a caret, and then the message.
  std::istringstream lines(read_text_file(messages));
  for (std::string line; std::getline(lines, line);)
    if (line.find("picture.gp") != std::string::npos && line.find("line ") != std::string::npos)
      result.error = line.substr(line.find("line "));
  if (result.error.empty()) result.error = fmt::format("gnuplot ended with status {}", status);
  return result;
}

}  // namespace grainfield::coupling
