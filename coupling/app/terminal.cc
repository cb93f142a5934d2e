#include "coupling/app/terminal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "coupling/base/printable.h"
#include "coupling/store/output_folder.h"

namespace grainfield::coupling {
namespace {

constexpr std::size_t kLongestLine = 1500;  // bytes
constexpr int kPatience = 1000;             // ms, for a line that is no result

std::string kept;
int failure = 0;  // errno of standard output; afterwards nothing more is written to it

/// errno, or 0. `done` counts the bytes; `patience`: ms for a reader that does not read, -1: all.
int write_all(int stream, const std::string& text, std::size_t& done, int patience = -1) {
  for (done = 0; done < text.size();) {
    const ssize_t n = write(stream, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) {  // a pipe that does not block: until its reader has read
      pollfd ready{stream, POLLOUT, 0};
      if (poll(&ready, 1, patience) != 0) continue;
      return EAGAIN;
    }
    if (n < 0) return errno;
    done += static_cast<std::size_t>(n);
  }
  return 0;
}

void put_error(const std::string& text) {
  std::size_t done = 0;
  if (write_all(STDERR_FILENO, text, done, kPatience) != 0) {
    // What goes to standard error is no result.
  }
}

// Where the next byte goes, of a regular file; -1 elsewhere.
off_t end_of_file() {
  struct stat is = {};
  if (fstat(STDOUT_FILENO, &is) != 0 || !S_ISREG(is.st_mode)) return -1;
  const int flags = fcntl(STDOUT_FILENO, F_GETFL);
  return (flags & O_APPEND) != 0 ? is.st_size : lseek(STDOUT_FILENO, 0, SEEK_CUR);
}

// Takes half a text back, where nobody has written behind it.
void cut_back(off_t start, std::size_t written) {
  struct stat is = {};
  if (start < 0 || written == 0 || fstat(STDOUT_FILENO, &is) != 0) return;
  if (is.st_size != start + static_cast<off_t>(written)) return;
  if (ftruncate(STDOUT_FILENO, start) == 0) lseek(STDOUT_FILENO, start, SEEK_SET);
}

void flush() {
  if (failure == 0 && !kept.empty()) {
    const off_t start = end_of_file();
    std::size_t written = 0;
    failure = write_all(STDOUT_FILENO, kept, written);
    if (failure != 0) cut_back(start, written);
  }
  kept.clear();
}

}  // namespace

void hold_standard_streams() {
  // Standard output for reading: what is written to it fails, as it would when closed.
  for (const auto& [stream, mode] :
       {std::pair{STDIN_FILENO, O_RDONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_WRONLY}}) {
    if (fcntl(stream, F_GETFD) >= 0) continue;
    // The lowest free number is this one.
    if (open("/dev/null", mode) < 0) return;
  }
}

void put(const std::string& text) {
  kept += printable(text);
  static const bool terminal = isatty(STDOUT_FILENO) != 0;
  if (terminal) flush();
}

void put_log(const std::string& line) { put_error(one_line(line, kLongestLine) + "\n"); }

void note_gone(const std::string& folder, const std::vector<std::filesystem::path>& gone) {
  if (!gone.empty()) note("{}", gone_note(folder, gone));
}

void put_progress(const std::string& line) { put_error("\r\033[K" + one_line(line, kLongestLine)); }

int finish_output() {
  flush();
  if (failure == 0) return 0;
  if (failure == EPIPE) return kExitPipe;
  note("standard output cannot be written: {}", std::strerror(failure));
  return kExitStorage;
}

std::string cell_text(const dem::Cell<3>& cell) {
  std::string axes, edges;
  for (int a = 0; a < 3; ++a) {
    if (!cell.periodic[static_cast<std::size_t>(a)]) continue;
    const Eigen::Vector3d e = cell.edges.col(a);
    axes += fmt::format("{}{}", axes.empty() ? "" : ", ", "xyz"[a]);
    edges += fmt::format("{}({:g}, {:g}, {:g})", edges.empty() ? "" : " and ", e.x(), e.y(), e.z());
  }
  std::string text = fmt::format("periodic along {}; edges {} m from ({:g}, {:g}, {:g})", axes,
                                 edges, cell.low.x(), cell.low.y(), cell.low.z());
  if (cell.velocity_gradient.isZero(0)) return text;
  text += "; velocity gradient (1/s)";
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      if (const double rate = cell.velocity_gradient(a, b); rate != 0)
        text += fmt::format(" {}{} {:g}", "xyz"[a], "xyz"[b], rate);
  return text;
}

}  // namespace grainfield::coupling
