// What signals do to a program that watches them: every test is a child process of its own.
#include "coupling/base/signals.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <memory>
#include <thread>

#include "coupling/store/atomic_file.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using namespace std::chrono_literals;

constexpr auto kSoon = 20s;  // for a busy machine; nothing waits as long when all is well

template <class Condition>
bool becomes_true(Condition condition) {
  const auto limit = std::chrono::steady_clock::now() + kSoon;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > limit) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

/// Runs the work in a child that watches signals; its exit code, or 128 + the signal it died of.
/// The work's own code counts when it returns.
int in_child(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    watch_signals();
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(Signals, EndTheProgramWithCode130) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EQ(in_child([number] {
                raise(number);
                std::this_thread::sleep_for(kSoon);
                return 0;
              }),
              130);
  }
}

TEST(Signals, WhatIsHalfDoneIsUndone) {
  const testing::Folder folder;
  EXPECT_EQ(in_child([&] {
              const OnSignal first([&] { folder.write("undone", "first"); });
              const OnSignal last([&] { folder.write("undone", "last"); });
              {
                const OnSignal over([&] { folder.write("over", ""); });
              }
              AtomicFile file(folder / "result.csv");
              folder.write(testing::fs::path(file.temporary()).filename().string(), "half");
              raise(SIGTERM);
              std::this_thread::sleep_for(kSoon);
              return 0;
            }),
            130);
  EXPECT_EQ(testing::read_text(folder / "undone"), "first");  // the last registered goes first
  EXPECT_FALSE(testing::fs::exists(folder / "over"));
  int files = 0;
  for (const auto& entry : testing::fs::directory_iterator(folder.path())) {
    EXPECT_EQ(entry.path().filename(), "undone");
    ++files;
  }
  EXPECT_EQ(files, 1);
}

TEST(Signals, PolledOnesSetAFlagAndTheSecondEnds) {
  EXPECT_EQ(in_child([] {
              const PolledSignals polled;
              if (interrupted()) return 1;
              raise(SIGINT);
              return becomes_true(interrupted) ? 7 : 2;
            }),
            7);
  EXPECT_EQ(in_child([] {
              const PolledSignals polled;
              raise(SIGINT);
              if (!becomes_true(interrupted)) return 2;
              std::this_thread::sleep_for(1500ms);
              raise(SIGINT);
              std::this_thread::sleep_for(kSoon);
              return 0;
            }),
            130);
}

TEST(Signals, SeveralAtOnceAreOne) {
  EXPECT_EQ(in_child([] {
              const PolledSignals polled;
              for (const int number : {SIGHUP, SIGTERM, SIGHUP}) {
                raise(number);
                std::this_thread::sleep_for(50ms);
              }
              return interrupted() ? 7 : 2;
            }),
            7);
}

TEST(Signals, HeldOnesAreTakenAfterwards) {
  EXPECT_EQ(in_child([] {
              {
                const HeldSignals held;
                raise(SIGINT);
                std::this_thread::sleep_for(300ms);
              }
              std::this_thread::sleep_for(kSoon);
              return 0;
            }),
            130);
  EXPECT_EQ(in_child([] {
              const PolledSignals polled;
              {
                const HeldSignals held;
                raise(SIGINT);
                std::this_thread::sleep_for(100ms);
                if (interrupted()) return 2;
              }
              return becomes_true(interrupted) ? 7 : 3;
            }),
            7);
}

TEST(Signals, HeldOnesAreForgottenWhenTheWorkIsDone) {
  EXPECT_EQ(in_child([] {
              {
                const HeldSignals held(AfterHold::forget);
                raise(SIGINT);
                raise(SIGTERM);
                std::this_thread::sleep_for(300ms);
              }
              std::this_thread::sleep_for(300ms);
              return 7;
            }),
            7);
}

TEST(Signals, WhoFailsMeanwhileWaitsForTheEnd) {
  EXPECT_EQ(in_child([] {
              std::atomic<bool> begun = false;
              const OnSignal slow([&] {
                begun = true;
                std::this_thread::sleep_for(500ms);
              });
              raise(SIGINT);
              if (!becomes_true([&] { return begun.load(); })) return 2;
              wait_if_stopping();
              return 1;
            }),
            130);
}

TEST(Signals, WhatIsUndoneIsNotMadeAgain) {
  const testing::Folder folder;
  const std::string made = folder / "made";
  EXPECT_EQ(in_child([&] {
              const OnSignal undo([&] {
                testing::fs::remove(made);
                std::this_thread::sleep_for(300ms);
              });
              raise(SIGTERM);
              const auto limit = std::chrono::steady_clock::now() + kSoon;
              while (std::chrono::steady_clock::now() < limit) {
                unless_stopping([&] { testing::fs::create_directory(made); });
              }
              return 0;
            }),
            130);
  EXPECT_FALSE(testing::fs::exists(made));
}

TEST(Signals, WritesThatCannotBeDoneSayItThemselves) {
  EXPECT_EQ(in_child([] {
              int ends[2];
              if (pipe(ends) != 0) return 1;
              close(ends[0]);
              return write(ends[1], "x", 1) < 0 && errno == EPIPE ? 7 : 2;
            }),
            7);
}

TEST(Signals, NohupHolds) {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGHUP, SIG_IGN);
    watch_signals();
    raise(SIGHUP);
    std::this_thread::sleep_for(300ms);
    _exit(7);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

}  // namespace
}  // namespace grainfield::coupling
