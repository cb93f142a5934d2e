// Two hands on one output: the second is told who has it, the first ends as if it were alone.
#include <gmock/gmock.h>

#include <memory>

#include "dem/snapshot/snapshot.h"
#include "tests/coupling/reliability_scene.h"

namespace grainfield::coupling::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::string host() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

void expect_in_use(const Ending& ending, const std::string& folder, pid_t owner) {
  EXPECT_EQ(ending.code, 2) << ending;
  ASSERT_THAT(complaints(ending.err), SizeIs(1)) << ending;
  EXPECT_THAT(complaints(ending.err).front(),
              AllOf(HasSubstr(folder + ": in use by process " + std::to_string(owner) + " on " +
                              host() + " ("),
                    HasSubstr("wait for it, or name another folder with -o")));
}

// A run that lasts until it is ended.
Start endless(const Folder& folder, const std::string& out) {
  return {{"run", folder.write("endless.toml", small_layer()), "-o", out, "--threads", "1", "--set",
           "load.ramp_time=3000"},
          {},
          "",
          {}};
}

bool at_work(const std::string& out) {
  return fs::exists(out + "/checkpoint/case.toml") && fs::exists(out + "/checkpoint/grains.txt");
}

TEST(Writers, TheSecondIsRefusedAndTheFirstEndsWhole) {
  const Folder folder;
  const std::string file =
                        folder.write("x.toml", small_layer("[quick.ensemble]\nrealizations = 1\n")),
                    out = folder / "out";
  const Start alone{{"run", file, "-o", folder / "alone"}, {}, "", {}};
  ASSERT_EQ(finish(alone).code, 0);
  Child first({{"run", file, "-o", out, "--threads", "1"}, {}, "", {}});
  ASSERT_TRUE(first.wait_until([&] { return at_work(out); }));
  // However long the others take to start, the first is still at it.
  first.send(SIGSTOP);
  for (const char* option : {"--resume", "--quick"})
    expect_in_use(finish({{"run", file, "-o", out, option}, {}, "", {}}), out, first.pid());
  // The same folder by other names.
  fs::create_directory_symlink(out, folder / "link");
  EXPECT_EQ(finish({{"run", file, "-o", folder / "link"}, {}, "", {}}).code, 2);
  EXPECT_EQ(finish({{"run", file, "-o", out + "/../out/."}, {}, "", {}}).code, 2);
  EXPECT_EQ(finish({{"run", file, "-o", "out"}, {}, folder.path(), {}}).code, 2);
  for (const Command& command : workshop().writing()) {
    if (command.writes == Writes::folder) expect_in_use(finish(command.to(out)), out, first.pid());
  }
  first.send(SIGCONT);
  const Ending ending = first.wait();
  EXPECT_EQ(ending.code, 0) << ending;
  EXPECT_EQ(difference(results_in(folder / "alone"), results_in(out)), "");
}

TEST(Writers, AKilledOwnerIsNoObstacle) {
  const Folder folder;
  const std::string out = folder / "out";
  for (int round = 0; round < 2; ++round) {
    Child killed(endless(folder, out));
    ASSERT_TRUE(killed.wait_until([&] { return at_work(out); }));
    killed.send(SIGKILL);
    EXPECT_EQ(killed.wait().signal, SIGKILL);
    Start again = endless(folder, out);
    again.words.emplace_back("--resume");
    Child next(again);
    next.wait_until([&] { return next.err().find("of grains") != std::string::npos; });
    EXPECT_TRUE(next.running()) << next.wait();
    next.send(SIGINT);
    EXPECT_EQ(next.wait().code, 130);
    fs::remove_all(out + "/checkpoint");
  }
}

TEST(Writers, OfTenAtOnceOneRuns) {
  const Folder folder;
  const std::string out = folder / "out";
  std::vector<std::unique_ptr<Child>> all;
  for (int k = 0; k < 10; ++k) all.push_back(std::make_unique<Child>(endless(folder, out)));
  const auto running = [&] {
    return std::count_if(all.begin(), all.end(), [](const auto& c) { return c->running(); });
  };
  const auto start = std::chrono::steady_clock::now();
  while (running() > 1 && seconds_since(start) < kPatience) sleep_for(0.01);
  ASSERT_EQ(running(), 1);
  const auto owner =
      std::find_if(all.begin(), all.end(), [](const auto& c) { return c->running(); });
  for (const auto& child : all) {
    if (child == *owner) continue;
    // Who comes just as the owner takes the folder may not learn its number yet.
    const Ending ending = child->wait();
    EXPECT_EQ(ending.code, 2) << ending;
    EXPECT_THAT(ending.err, HasSubstr(out + ": in use by "));
  }
  ASSERT_TRUE((*owner)->wait_until([&] { return at_work(out); }));
  (*owner)->send(SIGINT);
  EXPECT_EQ((*owner)->wait().code, 130);
  EXPECT_TRUE(at_work(out));
}

// Every command that said 0 has left its part; whoever could not says that it is in use.
TEST(Writers, ImportsIntoOneFileLoseNothing) {
  const Folder folder;
  const std::string file = folder / "all.h5";
  std::size_t added = 0;
  for (int round = 0; round < 3; ++round) {
    std::vector<std::unique_ptr<Child>> all;
    for (int k = 0; k < 6; ++k) {
      const std::string group = fmt::format("/round_{}/packing_{}", round, k);
      all.push_back(
          std::make_unique<Child>(workshop().import({"--add", "--group", group}).to(file)));
    }
    for (const auto& child : all) {
      const Ending ending = child->wait();
      added += ending.code == 0;
      if (ending.code == 0) continue;
      EXPECT_EQ(ending.code, 2) << ending;
      EXPECT_THAT(ending.err, HasSubstr("in use by "));
    }
  }
  EXPECT_GE(added, 3U);
  EXPECT_EQ(dem::list_snapshots(file).size(), added);
  EXPECT_EQ(leftovers(folder.path()), "");
}

TEST(Writers, CommandsOnOneFolderLeaveOneResult) {
  for (const Command& command : workshop().writing()) {
    if (command.writes != Writes::folder) continue;
    SCOPED_TRACE(command.name);
    const Folder folder;
    const std::string out = folder / "out";
    std::vector<std::unique_ptr<Child>> all;
    for (int k = 0; k < 5; ++k) all.push_back(std::make_unique<Child>(command.to(out)));
    int done = 0;
    for (const auto& child : all) {
      const Ending ending = child->wait();
      done += ending.code == 0;
      if (ending.code == 0) continue;
      EXPECT_EQ(ending.code, 2) << ending;
      EXPECT_THAT(ending.err, HasSubstr("in use by "));
    }
    EXPECT_GE(done, 1);
    ASSERT_EQ(finish(command.to(folder / "alone")).code, 0);
    EXPECT_EQ(difference(results_in(folder / "alone"), results_in(out)), "");
    EXPECT_EQ(leftovers(out), "");
  }
}

}  // namespace
}  // namespace grainfield::coupling::testing
