#include "coupling/app/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <mutex>

#include "continuum/progress.h"
#include "coupling/app/terminal.h"

namespace grainfield::coupling {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kEvery = std::chrono::seconds(5);         // elsewhere than on a terminal
constexpr auto kTaskPatience = std::chrono::seconds(3);  // from when a task first tells

struct Watched {
  std::mutex mutex;
  ProgressLine* line = nullptr;
  std::string task;
  Clock::time_point begin;
};

Watched& watched() {
  static Watched one;
  return one;
}

void show_task(const std::string& task, double share) {
  Watched& w = watched();
  const std::lock_guard lock(w.mutex);
  if (task != w.task) {
    w.task = task;
    w.begin = Clock::now();
  }
  if (w.line == nullptr || Clock::now() - w.begin < kTaskPatience) return;
  w.line->show([&] { return fmt::format("{}  {:.0f} %", task, 100 * share); });
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

TaskProgress::TaskProgress(ProgressLine& line) {
  Watched& w = watched();
  const std::lock_guard lock(w.mutex);
  w.line = &line;
  w.task.clear();
  continuum::watch_progress(show_task);
}

TaskProgress::~TaskProgress() {
  continuum::watch_progress(nullptr);
  Watched& w = watched();
  const std::lock_guard lock(w.mutex);
  w.line->end();
  w.line = nullptr;
}

std::string duration_text(double seconds) {
  if (!(seconds >= 0)) return "?";
  const auto s = static_cast<long>(seconds + 0.5);
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}

std::string progress_text(const EnsembleProgress& p) {
  if (p.phase.empty()) {
    return fmt::format("{:3.0f} %  {}/{} done{}", 100 * p.fraction, p.done, p.total,
                       p.done < p.total ? "  starting" : "");
  }
  const std::string awake =
      p.awake > 0 && p.awake < p.grains ? fmt::format(", {} awake", p.awake) : "";
  // The quasi-static solver has neither time nor speeds.
  const bool moving = p.simulated_time > 0;
  const std::string time = moving ? fmt::format("  t {:.3f} s", p.simulated_time) : "";
  const std::string forces = moving ? fmt::format("  kinetic {:.1e} J  unbalanced {:.1e}",
                                                  p.kinetic_energy, p.unbalanced_force_ratio)
                                    : "";
  return fmt::format("{:3.0f} %  {}/{} done  {}{}  {} grains{}{}  {} left", 100 * p.fraction,
                     p.done, p.total, p.phase, time, p.grains, awake, forces,
                     duration_text(p.seconds_left));
}

}  // namespace grainfield::coupling
