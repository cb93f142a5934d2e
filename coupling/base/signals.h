// What SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGXCPU do.
//
// As a rule a signal ends the program at once, with exit code 130: what would be left half done is
// undone (OnSignal) and one line says what remains. Two kinds of work ask for something else while
// they last: PolledSignals, which saves its state first, and HeldSignals, which moves results to
// their places and must not be cut in two.
#pragma once
#include <functional>
#include <stdexcept>
#include <string>

namespace grainfield::coupling {

inline constexpr int kExitInterrupted = 130;

/// The work was stopped from outside and can be continued; the message says how. Exit code 130.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// From now on signals are met as described above, by a thread of its own; SIGPIPE and SIGXFSZ are
/// ignored, so that a write that fails says so. The program calls it once, before all else; without
/// it signals do what they do by default.
void watch_signals();

/// The line that a signal leaves on standard error, after "grainfield: ", from now on.
void say_when_stopped(const std::string& line);

/// While it lives, the first signal only sets the flag that interrupted() tells; another one ends
/// the program at once, but not within a second of the first: a terminal that closes, or a batch
/// system, sends several.
class PolledSignals {
 public:
  PolledSignals();
  ~PolledSignals();
  PolledSignals(const PolledSignals&) = delete;
  PolledSignals& operator=(const PolledSignals&) = delete;
};

/// Whether a signal has come while PolledSignals lived.
bool interrupted();

/// Sets that flag as a signal does, where PolledSignals lives: for a host with signals of its own.
void interrupt_polled_work();

/// What becomes of a signal that had to wait: it is taken then, or forgotten, because the work it
/// would have stopped is done.
enum class AfterHold { take, forget };

/// While it lives, a signal waits. Of nested ones the outermost decides what becomes of it.
class HeldSignals {
 public:
  explicit HeldSignals(AfterHold after = AfterHold::take);
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  AfterHold after_;
};

/// While it lives, `undo` runs before a signal ends the program: on another thread, once, while the
/// work goes on until the exit; it must not throw.
class OnSignal {
 public:
  explicit OnSignal(std::function<void()> undo);
  ~OnSignal();
  OnSignal(const OnSignal&) = delete;
  OnSignal& operator=(const OnSignal&) = delete;

 private:
  int number_;
};

/// Does the work while no signal can end the program in between; when one is just ending it, never
/// returns. For what must not be made again once `undo` has removed it.
void unless_stopping(const std::function<void()>& work);
/// Returns at once, or, when a signal is just ending the program, never. Whoever reports a failure
/// asks first: it may come from what `undo` took away.
void wait_if_stopping();

}  // namespace grainfield::coupling
