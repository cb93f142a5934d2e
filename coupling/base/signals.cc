#include "coupling/base/signals.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>

#include "coupling/base/printable.h"

namespace grainfield::coupling {
namespace {

constexpr int kStopping[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU};
constexpr std::chrono::seconds kOneSignal{1};  // those that come within it are one
constexpr std::size_t kLongestLine = 1500;     // bytes
constexpr int kPatience = 200;  // ms, for the line on a standard error that nobody reads

int bell = -1;  // an eventfd: the handler rings it, the watcher waits for it
std::atomic<bool> flag = false;

struct State {
  std::mutex mutex;  // of all below; for ever locked once a signal ends the program
  int polled = 0, held = 0;
  bool waiting = false;                         // a signal came while held
  std::chrono::steady_clock::time_point first;  // when the flag was set
  std::string line = "stopped";
  std::map<int, std::function<void()>> undoes;
  int next_undo = 0;
};

// Never destroyed: a signal may come while the program is already on its way out.
State& state() {
  static State* one = new State;
  return *one;
}

extern "C" void ring(int) {
  const int kept = errno;
  const std::uint64_t one = 1;
  // A full counter has rung already.
  if (write(bell, &one, sizeof one) < 0) errno = kept;
  errno = kept;
}

[[noreturn]] void stop() {
  State& s = state();
  std::string line = isatty(STDERR_FILENO) != 0 ? "\n" : "";
  line += "grainfield: " + s.line + "\n";
  pollfd ready{STDERR_FILENO, POLLOUT, 0};
  if (poll(&ready, 1, kPatience) == 1 && (ready.revents & POLLOUT) != 0 &&
      write(STDERR_FILENO, line.data(), line.size()) < 0) {
    // Nobody is left to be told.
  }
  // The last registered first: as destructors would.
  for (auto at = s.undoes.rbegin(); at != s.undoes.rend(); ++at) at->second();
  _exit(kExitInterrupted);
}

void watch() {
  State& s = state();
  std::uint64_t rings = 0;
  while (true) {
    if (read(bell, &rings, sizeof rings) < 0) continue;
    std::unique_lock lock(s.mutex);
    const auto now = std::chrono::steady_clock::now();
    if (s.held > 0) {
      s.waiting = true;
    } else if (s.polled > 0 && !flag) {
      flag = true;
      s.first = now;
    } else if (s.polled == 0 || now - s.first > kOneSignal) {
      lock.release();  // never unlocked: whoever meets the mutex now waits for the exit
      stop();
    }
  }
}

}  // namespace

void watch_signals() {
  static std::once_flag once;
  std::call_once(once, [] {
    bell = eventfd(0, EFD_CLOEXEC);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    if (bell < 0) return;
    try {
      std::thread(watch).detach();
    } catch (const std::system_error&) {
      return;  // no thread to be had: signals do what they do by default
    }
    struct sigaction action = {};
    action.sa_handler = ring;
    action.sa_flags = SA_RESTART;
    for (const int number : kStopping) {
      struct sigaction before = {};
      sigaction(number, nullptr, &before);
      const bool nohup = number == SIGHUP && before.sa_handler == SIG_IGN;
      if (!nohup) sigaction(number, &action, nullptr);
    }
  });
}

void say_when_stopped(const std::string& line) {
  const std::lock_guard lock(state().mutex);
  state().line = one_line(line, kLongestLine);
}

PolledSignals::PolledSignals() {
  const std::lock_guard lock(state().mutex);
  flag = false;
  ++state().polled;
}

PolledSignals::~PolledSignals() {
  const std::lock_guard lock(state().mutex);
  --state().polled;
}

bool interrupted() { return flag; }

void interrupt_polled_work() {
  const std::lock_guard lock(state().mutex);
  if (state().polled > 0) flag = true;
}

HeldSignals::HeldSignals(AfterHold after) : after_(after) {
  const std::lock_guard lock(state().mutex);
  ++state().held;
}

HeldSignals::~HeldSignals() {
  const std::lock_guard lock(state().mutex);
  if (--state().held > 0 || !state().waiting) return;
  state().waiting = false;
  if (after_ == AfterHold::take) ring(0);
}

OnSignal::OnSignal(std::function<void()> undo) {
  const std::lock_guard lock(state().mutex);
  number_ = state().next_undo++;
  state().undoes.emplace(number_, std::move(undo));
}

OnSignal::~OnSignal() {
  const std::lock_guard lock(state().mutex);
  state().undoes.erase(number_);
}

void unless_stopping(const std::function<void()>& work) {
  const std::lock_guard lock(state().mutex);
  work();
}

void wait_if_stopping() { const std::lock_guard lock(state().mutex); }

}  // namespace grainfield::coupling
