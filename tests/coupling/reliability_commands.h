// Commands that are interrupted while they write: their output is the old or the new one.
#pragma once
#include <gmock/gmock.h>

#include <random>

#include "reliability_scene.h"

namespace grainfield::coupling::testing {

struct CommandTally {
  int signals = 0, killed = 0, old = 0, fresh = 0;
  void print() const {
    std::printf(
        "reliability: commands: %d interruptions (kill -9 %d); the output was the old one %d "
        "times, the new one %d times\n",
        signals, killed, old, fresh);
  }
};

/// A command over an output that is there already.
class InterruptedCommand {
 public:
  InterruptedCommand(Command command, std::mt19937& random, CommandTally& tally)
      : command_(std::move(command)), random_(random), tally_(tally) {
    make_earlier();
    const Folder folder;
    prepare(folder);
    before_ = results_in(folder.path());
    const auto start = std::chrono::steady_clock::now();
    const Ending ending = finish(command_.to(folder / output()));
    seconds_ = seconds_since(start);
    if (ending.code != 0) throw std::runtime_error(command_.name + ": " + ending.err);
    after_ = results_in(folder.path());
  }

  void strike(int signal, bool group, bool while_writing) {
    const Folder folder;
    prepare(folder);
    Child child(command_.to(folder / output()));
    const double delay = std::uniform_real_distribution<>(0, 1.1 * seconds_)(random_);
    child.wait_until([&] { return signal == SIGKILL || child.catches(signal); });
    child.wait_until([&] { return while_writing && !leftovers(folder.path()).empty(); },
                     while_writing ? kPatience : delay);
    const std::string what = command_.name + ", " + strsignal(signal) +
                             (while_writing ? " while writing" : " after " + std::to_string(delay));
    SCOPED_TRACE(what);
    const bool struck = child.running();
    if (struck) group ? child.send_group(signal) : child.send(signal);
    const Ending ending = child.wait();
    ASSERT_FALSE(ending.late) << ending;
    const Contents found = readable(folder);
    if (struck) ++tally_.signals;
    if (signal == SIGKILL) {
      tally_.killed += struck;
      EXPECT_TRUE(ending.signal == SIGKILL || ending.code == 0) << ending;
      EXPECT_EQ(mixture(before_, after_, found), "");
    } else {
      EXPECT_TRUE(ending.code == 130 || ending.code == 0) << ending;
      EXPECT_EQ(leftovers(folder.path()), "");
      // A signal at the very end may find everything in its place.
      const bool fresh = ending.code == 0 || difference(after_, found).empty();
      EXPECT_EQ(difference(fresh ? after_ : before_, found), "");
      tally_.fresh += struck && fresh;
      tally_.old += struck && !fresh;
    }
    // Whatever happened, the same command ends well.
    Start again = command_.to(folder / output());
    // A packing is not added twice.
    const bool added = found == after_ && command_.words.back() == "/added";
    const Ending done = finish(again);
    EXPECT_EQ(done.code, added ? 2 : 0) << done;
    EXPECT_EQ(difference(after_, readable(folder)), "");
  }

 private:
  std::string output() const { return "out" + command_.ending(); }

  // The earlier output: the command's own, and then changed, so that it differs from the new one; a
  // packing is added to a file of one.
  void make_earlier() {
    const bool adds = command_.words.back() == "/added";
    const Command first = adds ? workshop().import({"--group", "/first"}) : command_;
    const Ending ending = finish(first.to(earlier_ / output()));
    if (ending.code != 0) throw std::runtime_error(command_.name + ": " + ending.err);
    if (adds) return;
    for (const auto& entry : fs::recursive_directory_iterator(earlier_.path())) {
      if (entry.is_regular_file() && !is_bookkeeping(entry.path()))
        std::ofstream(entry.path(), std::ios::app) << "old\n";
    }
  }

  void prepare(const Folder& folder) const {
    fs::copy(earlier_.path(), folder.path(), fs::copy_options::recursive);
  }

  // Without what was being written.
  static Contents readable(const Folder& folder) {
    Contents out = results_in(folder.path());
    std::erase_if(out, [](const auto& file) {
      return file.first.find(".partial") != std::string::npos ||
             fs::path(file.first).extension() == ".part";
    });
    return out;
  }

  Command command_;
  Folder earlier_;
  std::mt19937& random_;
  CommandTally& tally_;
  Contents before_, after_;
  double seconds_ = 0;
};

inline CommandTally interrupt_commands(int rounds) {
  CommandTally tally;
  std::mt19937 random(attack_seed());
  const Workshop& inputs = workshop();
  for (const Command& command : {inputs.model(), inputs.average("150x80"), inputs.strain("300x200"),
                                 inputs.import(), inputs.import({"--add", "--group", "/added"}),
                                 inputs.compare(), inputs.fit(), inputs.structure()}) {
    InterruptedCommand victim(command, random, tally);
    for (int round = 0; round < rounds && !::testing::Test::HasFailure(); ++round) {
      constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGKILL};
      victim.strike(kSignals[static_cast<std::size_t>(round) % 4], random() % 2 == 0,
                    random() % 2 == 0);
    }
  }
  return tally;
}

}  // namespace grainfield::coupling::testing
