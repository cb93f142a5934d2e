#include "coupling/app/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <mutex>

#include "continuum/progress.h"
#include "coupling/app/terminal.h"

namespace grainfield::coupling {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kEvery = std::chrono::seconds(5);           // elsewhere than on a terminal
constexpr auto kSolverPatience = std::chrono::seconds(3);  // before a solver is spoken of

struct Watched {
  std::mutex mutex;
  std::unique_ptr<ProgressLine> line;
  Clock::time_point begin;
};

Watched& watched() {
  static Watched one;
  return one;
}

void show_solver(const std::string& solver, double share) {
  Watched& w = watched();
  const std::lock_guard lock(w.mutex);
  if (!w.line || Clock::now() - w.begin < kSolverPatience) return;
  w.line->show([&] { return fmt::format("{}  {:.0f} % of the load", solver, 100 * share); });
}

}  // namespace

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

bool ProgressLine::due() {
  if (quiet_) return false;
  const auto now = Clock::now();
  if (!terminal_ && now - last_ < kEvery) return false;
  last_ = now;
  return true;
}

void ProgressLine::put(const std::string& line) {
  if (terminal_) {
    put_progress(line);
    open_ = true;
  } else {
    put_log(line);
  }
}

void ProgressLine::note(const std::string& text) {
  if (quiet_) return;
  end();
  put_log(text);
}

void ProgressLine::end() {
  if (open_) put_log("");
  open_ = false;
}

SolverProgress::SolverProgress() {
  Watched& w = watched();
  const std::lock_guard lock(w.mutex);
  w.line = std::make_unique<ProgressLine>(false);
  w.begin = Clock::now();
  continuum::watch_progress(show_solver);
}

SolverProgress::~SolverProgress() {
  continuum::watch_progress(nullptr);
  Watched& w = watched();
  const std::lock_guard lock(w.mutex);
  if (w.line) w.line->end();
  w.line.reset();
}

}  // namespace grainfield::coupling
