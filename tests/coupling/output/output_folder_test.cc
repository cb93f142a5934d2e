// Folders of results: complete or not at all, one writer at a time, nothing of the user's touched.
#include "coupling/store/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "coupling/store/atomic_file.h"
#include "tests/coupling/program.h"
#include "tests/refusal.h"

namespace grainfield::coupling {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::fs::exists;

// Name and text of what stands in the folder, without the list of results.
std::map<std::string, std::string> found(const testing::Folder& folder,
                                         const std::string& inner = "out") {
  auto all = testing::contents(folder / inner);
  all.erase(".results");
  return all;
}

std::vector<testing::fs::path> publish(const testing::Folder& folder,
                                       const std::map<std::string, std::string>& files) {
  OutputFolder out(folder / "out", "grainfield test");
  for (const auto& [name, text] : files) write_text_file(out.staging(name), text);
  return out.publish();
}

using Files = std::map<std::string, std::string>;

TEST(OutputFolder, NothingStaysOfWorkThatFailed) {
  const testing::Folder folder;
  {
    OutputFolder out(folder / "a/b/out", "grainfield test");
    write_text_file(out.staging("inner/x.csv"), "1");
  }
  EXPECT_FALSE(exists(folder / "a"));
  testing::fs::create_directory(folder / "kept");
  { OutputFolder out(folder / "kept", "grainfield test"); }
  EXPECT_TRUE(testing::fs::is_empty(folder / "kept"));
}

TEST(OutputFolder, ResultsOfAnotherStudyGo) {
  const testing::Folder folder;
  publish(folder, {{"heaps.csv", "old"},
                   {"summary.json", "old"},
                   {"friction_0.3/summary.json", "old"},
                   {"friction_0.3/deep/x.csv", "old"}});
  folder.write("out/heaps-of-mine.csv", "mine");
  testing::fs::create_directory(folder / "out/friction_0.3/mine");
  folder.write("out/friction_0.3/mine/note.txt", "mine");
  const auto gone = publish(folder, {{"summary.json", "new"}, {"profiles.csv", "new"}});
  EXPECT_EQ(gone_note("out", gone),
            "out: 3 results of an earlier command are gone: friction_0.3/deep/x.csv, "
            "friction_0.3/summary.json, heaps.csv");
  EXPECT_EQ(gone_note("out", {}), "");
  EXPECT_EQ(found(folder), (Files{{"summary.json", "new\n"},
                                  {"profiles.csv", "new"},
                                  {"heaps-of-mine.csv", "mine"},
                                  {"friction_0.3/mine/note.txt", "mine"}}));
  EXPECT_FALSE(exists(folder / "out/friction_0.3/deep"));
}

TEST(OutputFolder, ResultsOfVersionsWithoutAListGo) {
  const testing::Folder folder;
  testing::fs::create_directory(folder / "out");
  for (const std::string name : {"summary.json", "case.toml", "heaps.csv", "grains_pile.vtu"}) {
    folder.write("out/" + name, "old");
  }
  folder.write("out/notes.txt", "mine");
  publish(folder, {{"summary.json", "new"}});
  EXPECT_EQ(found(folder),
            (Files{{"summary.json", "new\n"}, {"notes.txt", "mine"}, {"case.toml", "old"}}));
}

TEST(OutputFolder, AFolderThatHoldsNoResultsLosesNothing) {
  const testing::Folder folder;
  testing::fs::create_directory(folder / "out");
  folder.write("out/mine.vtu", "mine");
  folder.write("out/report.html", "mine");
  publish(folder, {{"profiles.csv", "new"}});
  EXPECT_EQ(found(folder),
            (Files{{"mine.vtu", "mine"}, {"report.html", "mine"}, {"profiles.csv", "new"}}));
}

TEST(OutputFolder, AListThatPointsElsewhereHarmsNobody) {
  const testing::Folder folder;
  publish(folder, {{"x.csv", "old"}});
  folder.write("out/.results", "../victim\n" + (folder / "victim") + "\na/../../victim\n\nx.csv\n");
  folder.write("victim", "alive");
  publish(folder, {{"y.csv", "new"}});
  EXPECT_EQ(testing::read_text(folder / "victim"), "alive");
  EXPECT_EQ(found(folder), (Files{{"y.csv", "new"}}));
}

TEST(OutputFolder, AFolderThatHasBecomeALinkIsLeftAlone) {
  const testing::Folder folder;
  publish(folder, {{"member/x.csv", "old"}});
  testing::fs::rename(folder / "out/member", folder / "elsewhere");
  testing::fs::create_directory_symlink(folder / "elsewhere", folder / "out/member");
  publish(folder, {{"y.csv", "new"}});
  EXPECT_EQ(testing::read_text(folder / "elsewhere/x.csv"), "old");
}

TEST(OutputFolder, WhatIsInTheWayIsSeenBeforeAnythingGoes) {
  const testing::Folder folder;
  publish(folder, {{"summary.json", "old"}, {"x.csv", "old"}});
  folder.write("out/member", "mine");
  EXPECT_THAT(refusal_of([&] {
                publish(folder, {{"member/y.csv", "new"}});
              }),
              HasSubstr("out/member: cannot write there: "));
  testing::fs::create_directory(folder / "out/z.csv");
  EXPECT_THAT(refusal_of([&] {
                publish(folder, {{"z.csv", "new"}});
              }),
              HasSubstr("out/z.csv: is in the way of a result"));
  EXPECT_EQ(found(folder),
            (Files{{"summary.json", "old\n"}, {"x.csv", "old"}, {"member", "mine"}}));
}

// A result replaces results alone.
TEST(OutputFolder, AFileOfTheUsersIsNotReplaced) {
  const testing::Folder folder;
  testing::fs::create_directory(folder / "out");
  folder.write("out/report.html", "mine");
  const auto again = [&] { publish(folder, {{"report.html", "new"}, {"x.csv", "new"}}); };
  EXPECT_THAT(refusal_of(again),
              AllOf(HasSubstr("out/report.html: is no result of an earlier command"),
                    HasSubstr("move it, or name another folder with -o")));
  EXPECT_EQ(found(folder), (Files{{"report.html", "mine"}}));
  testing::fs::remove(folder / "out/report.html");
  again();
  again();  // what was published before is ours
  EXPECT_EQ(found(folder), (Files{{"report.html", "new"}, {"x.csv", "new"}}));
  folder.write("out/y.csv", "mine");
  EXPECT_THAT(refusal_of([&] {
                publish(folder, {{"y.csv", "new"}});
              }),
              HasSubstr("out/y.csv: is no result"));
  EXPECT_EQ(found(folder), (Files{{"report.html", "new"}, {"x.csv", "new"}, {"y.csv", "mine"}}));
}

TEST(OutputFolder, ResultsOfVersionsWithoutAListAreReplaced) {
  const testing::Folder folder;
  testing::fs::create_directories(folder / "out/friction_0.3");
  for (const char* name : {"out/summary.json", "out/fits.csv", "out/odd.csv",
                           "out/friction_0.3/summary.json", "out/friction_0.3/odd.csv"}) {
    folder.write(name, "old");
  }
  publish(folder, {{"odd.csv", "new"}, {"friction_0.3/odd.csv", "new"}});
  EXPECT_EQ(testing::read_text(folder / "out/friction_0.3/odd.csv"), "new");
  // `structure` left no summary.
  testing::fs::remove_all(folder / "out");
  testing::fs::create_directory(folder / "out");
  for (const char* name : {"out/grains.csv", "out/coordination.csv", "out/base_forces.csv"}) {
    folder.write(name, "old");
  }
  publish(folder, {{"grains.csv", "new"}, {"coordination.csv", "new"}});
  EXPECT_EQ(testing::read_text(folder / "out/grains.csv"), "new");
}

TEST(OutputFolder, NamesOfFilesAreNoFolders) {
  const testing::Folder folder;
  EXPECT_THAT(refusal_of([&] { OutputFolder(folder / "table.csv", "structure"); }),
              AllOf(HasSubstr("what is written is a folder"), HasSubstr("table")));
  EXPECT_FALSE(exists(folder / "table.csv"));
  EXPECT_EQ(refusal_of([&] { OutputFolder(folder / "run.2", "run"); }), "accepted");
}

TEST(OutputFolder, WhatIsNoFolderIsCalledByItsKind) {
  const testing::Folder folder;
  const auto open = [&](const std::string& name) {
    return refusal_of([&] { const OutputFolder out(name, "grainfield test"); });
  };
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  testing::fs::create_symlink("nowhere", folder / "link");
  folder.write("file", "");
  EXPECT_THAT(open(folder / "pipe"), HasSubstr("cannot write there: it is a pipe"));
  EXPECT_THAT(open("/dev/null"), HasSubstr("cannot write there: it is a device"));
  EXPECT_THAT(open(folder / "file"), HasSubstr("cannot write there: it is a file"));
  EXPECT_THAT(open(folder / "link"),
              HasSubstr("cannot write there: it is a link to nowhere, which leads nowhere"));
}

// What kill -9 left, at whatever instant, does not stand in the way and goes.
TEST(OutputFolder, LeftoversOfAKilledOneGo) {
  const testing::Folder folder;
  for (const char* inner : {"out/.partial/old", "out/.partial-gone/old"}) {
    testing::fs::create_directories(folder / inner);
    folder.write(std::string(inner) + "/x.csv", "half");
  }
  std::string mine;
  const pid_t child = fork();
  if (child == 0) {
    AtomicFile half(folder / "out/y.csv");
    half.write("half");
    raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  const AtomicFile alive(folder / "out/z.csv");
  alive.write("of a living process");
  std::string name = testing::fs::path(alive.temporary()).filename();
  EXPECT_EQ(testing::contents(folder / "out").size(), 4U);
  publish(folder, {{"x.csv", "new"}});
  EXPECT_EQ(found(folder), (Files{{"x.csv", "new"}, {name, "of a living process"}}));
  EXPECT_FALSE(exists(folder / "out/.partial-gone"));
}

TEST(OutputFolder, ResultsThatAreInputsAreNotReplaced) {
  const testing::Folder folder;
  publish(folder, {{"snapshots.h5", "grains"}});
  OutputFolder out(folder / "out", "grainfield test");
  EXPECT_THAT(refusal_of([&] { out.require_other_than({folder / "out/../out/snapshots.h5"}); }),
              HasSubstr("its result snapshots.h5 is an input and would be replaced"));
  EXPECT_EQ(refusal_of([&] { out.require_other_than({folder / "elsewhere.h5"}); }), "accepted");
}

TEST(OutputFolder, TwoWritersAreOneTooMany) {
  const testing::Folder folder;
  const OutputFolder out(folder / "out", "grainfield run \x1b[2Jcase.toml");
  const std::string why =
      refusal_of([&] { const OutputFolder other(folder / "out", "grainfield fit"); });
  EXPECT_THAT(why, AllOf(HasSubstr("out: in use by process " + std::to_string(getpid()) + " on "),
                         HasSubstr("(grainfield run \\x1b[2Jcase.toml); wait for it")));
}

TEST(OutputFolder, ALockOutlivesNobody) {
  const testing::Folder folder;
  const pid_t child = fork();
  if (child == 0) {
    const OutputFolder out(folder / "out", "grainfield test");
    write_text_file(out.staging("half.csv"), "half");
    raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(exists(folder / "out/.lock"));
  publish(folder, {{"x.csv", "new"}});
  EXPECT_EQ(found(folder), (Files{{"x.csv", "new"}}));
}

// As after kill -9 while a child of the killed process is at work: it holds the lock a little
// longer.
TEST(OutputFolder, ALockIsWaitedForWhoseHolderIsDead) {
  const testing::Folder folder;
  const pid_t child = fork();
  if (child == 0) {
    const OutputFolder out(folder / "out", "grainfield test");
    if (fork() == 0) {
      usleep(1'000'000);
      _exit(0);
    }
    raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  publish(folder, {{"x.csv", "new"}});
  EXPECT_EQ(found(folder), (Files{{"x.csv", "new"}}));
}

}  // namespace
}  // namespace grainfield::coupling
