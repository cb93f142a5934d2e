#include "dem/hdf5/child.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "dem/shared/number.h"

namespace grainfield::dem {
namespace {

// On a busy machine, or a slow disk, the clock runs so many times faster than the CPU's.
constexpr double kWallShare = 30;
constexpr std::array<int, 4> kStopping{SIGINT, SIGTERM, SIGHUP, SIGQUIT};
// What the child says at its end.
constexpr char kTrue = 't', kFalse = 'f', kRefused = 'r';

// Whether the address sanitizer is there, as GCC and clang say it: it needs terabytes of addresses.
#ifdef __SANITIZE_ADDRESS__
#define GRAINFIELD_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define GRAINFIELD_ADDRESS_SANITIZER
#endif
#endif

#ifndef GRAINFIELD_ADDRESS_SANITIZER
// Address space in use, bytes; 0: not known. Of the child itself: threads of its parent take and
// give back some (128 MB for an arena's alignment) between any look from there and the fork.
double memory_in_use() {
  const int in = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (in < 0) return 0;
  std::array<char, 64> text{};
  const ssize_t count = read(in, text.data(), text.size() - 1);
  close(in);
  if (count <= 0) return 0;
  const std::string_view all(text.data(), static_cast<std::size_t>(count));
  const auto pages = parse_integer(all.substr(0, all.find(' ')));
  return static_cast<double>(pages.value_or(0)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}
#endif

// Signals of a crash end the child as they would any program; those that ask to stop are its
// parent's matter.
void take_signals() {
  for (const int s : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM, SIGXCPU, SIGPIPE}) {
    std::signal(s, SIG_DFL);
  }
  for (const int s : kStopping) std::signal(s, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

void lower(decltype(RLIMIT_CPU) what, double to) {
  rlimit limit{};
  if (getrlimit(what, &limit) != 0) return;
  const auto wanted = static_cast<rlim_t>(to);
  if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur > wanted) limit.rlim_cur = wanted;
  setrlimit(what, &limit);
}

[[noreturn]] void be_the_child(pid_t parent, const ChildLimits& limits, int answer,
                               const std::function<bool()>& work) {
  // It holds what its parent holds, locks too: it must not outlive it.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  take_signals();
  const int nothing = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (stream != answer) dup2(nothing, stream);
  }
  lower(RLIMIT_CORE, 0);
  lower(RLIMIT_CPU, std::ceil(limits.seconds));
  const double clock = limits.clock > 0 ? limits.clock : kWallShare * limits.seconds;
  alarm(static_cast<unsigned>(std::min(std::ceil(clock), 1e6)));
#ifndef GRAINFIELD_ADDRESS_SANITIZER
  if (const double in_use = memory_in_use(); in_use > 0) {
    lower(RLIMIT_AS, in_use + limits.memory);
  }
#endif
  char letter = kFalse;
  try {
    if (work()) letter = kTrue;
  } catch (const std::invalid_argument&) {
    letter = kRefused;
  } catch (...) {
  }
  if (write(answer, &letter, 1) != 1) _exit(1);
  _exit(0);
}

}  // namespace

ChildResult run_in_child(const ChildLimits& limits, const std::function<bool()>& work) {
  std::array<int, 2> answer{};
  if (pipe2(answer.data(), O_CLOEXEC) != 0) return {ChildEnd::unknown, ""};
  const pid_t parent = getpid();
  // What asks to stop waits until the child ignores it.
  sigset_t stopping, before;
  sigemptyset(&stopping);
  for (const int s : kStopping) sigaddset(&stopping, s);
  pthread_sigmask(SIG_BLOCK, &stopping, &before);
  const pid_t child = fork();
  if (child == 0) be_the_child(parent, limits, answer[1], work);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  close(answer[1]);
  char letter = 0;
  while (child > 0 && read(answer[0], &letter, 1) < 0 && errno == EINTR) {
  }
  close(answer[0]);
  if (child < 0) return {ChildEnd::unknown, ""};
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(child, &status, 0)) < 0 && errno == EINTR) {
  }
  if (letter == kTrue) return {ChildEnd::ok, ""};
  if (letter == kFalse) return {ChildEnd::failed, ""};
  if (letter == kRefused) return {ChildEnd::refused, ""};
  // Who ignores SIGCHLD is not told how it ended.
  if (ended != child || !WIFSIGNALED(status)) return {ChildEnd::crashed, ""};
  const int number = WTERMSIG(status);
  const char* name = sigabbrev_np(number);
  const bool endless = number == SIGXCPU || number == SIGALRM;
  return {endless             ? ChildEnd::endless
          : number == SIGKILL ? ChildEnd::killed
                              : ChildEnd::crashed,
          name != nullptr ? std::string("SIG") + name : ""};
}

}  // namespace grainfield::dem
