// What the program says where something stands in its way, and what it leaves alone then.
#include <gmock/gmock.h>

#include "tests/coupling/reliability_scene.h"

namespace grainfield::coupling::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class MessagesTest : public ::testing::Test {
 protected:
  Ending run(const std::vector<std::string>& more, rlim_t file_size = RLIM_INFINITY) {
    Start start{{"run", file_, "--threads", "1"}, {}, "", {}};
    start.words.insert(start.words.end(), more.begin(), more.end());
    start.file_size = file_size;
    return finish(start);
  }
  void refused(const Ending& ending, const ::testing::Matcher<const std::string&>& what) {
    EXPECT_EQ(ending.code, 2) << ending;
    EXPECT_THAT(complaints(ending.err), ElementsAre(what));
  }
  Folder folder_;
  std::string file_ = folder_.write("x.toml", small_layer("[output]\nreport = false\n"));
  std::string out_ = folder_ / "out";
};

TEST_F(MessagesTest, ResumingWhereNothingHasBegun) {
  refused(run({"-o", out_, "--resume"}),
          HasSubstr("--resume: nothing to resume in " + out_ +
                    ": found no such folder; leave --resume out to start anew"));
  EXPECT_FALSE(fs::exists(out_));
  fs::create_directory(out_);
  refused(run({"-o", out_, "--resume"}), HasSubstr(": found an empty folder; leave --resume out"));
  folder_.write("out/notes", "mine");
  refused(run({"-o", out_, "--resume"}), HasSubstr(": found a folder without checkpoint/; leave"));
  // A slip of the pen.
  fs::create_directories(folder_ / "friction/checkpoint");
  refused(run({"-o", folder_ / "frction", "--resume"}),
          HasSubstr("found no such folder; an unfinished run is in friction; leave"));
  EXPECT_FALSE(fs::exists(folder_ / "frction"));
  // Stopped before its first checkpoint: then it starts anew.
  fs::create_directory(out_ + "/checkpoint");
  const Ending ending = run({"-o", out_, "--resume"});
  EXPECT_EQ(ending.code, 0) << ending;
  EXPECT_THAT(ending.err, HasSubstr("nothing to resume in " + out_ + " yet: starting anew"));
  refused(run({"-o", out_, "--resume"}), HasSubstr("is finished; leave --resume out"));
}

TEST_F(MessagesTest, AnOutputWithoutAName) {
  for (const Command& command : workshop().writing()) {
    Start start = command.to("");
    start.words.insert(start.words.end(), {"-o", ""});
    const Ending ending = finish(start);
    EXPECT_EQ(ending.code, 2) << command.name << ": " << ending;
    EXPECT_THAT(ending.err, HasSubstr("--output: found no name")) << command.name;
  }
}

TEST_F(MessagesTest, ASettingWithoutAValue) {
  for (const char* set : {"title=", "title= "}) {
    refused(run({"-o", out_, "--set", set}),
            HasSubstr("--set: title: found no value, expected title=VALUE (a text may be empty: "
                      "title='\"\"')"));
  }
  EXPECT_EQ(finish({{"check", file_, "--set", "title=\"\""}, {}, "", {}}).code, 0);
}

TEST_F(MessagesTest, NamesOfFoldersDoNotSteer) {
  const std::string out = folder_ / "a\nb\x1b[2J";
  const Ending ending = run({"-o", out});
  EXPECT_EQ(ending.code, 0) << ending;
  EXPECT_THAT(ending.out, HasSubstr("results: " + (folder_ / "a\\x0ab\\x1b[2J") + "\n"));
  Child child({{"run", file_, "--set", "load.ramp_time=50", "-o", out}, {}, "", {}});
  child.wait_until([&] { return child.err().find("of grains") != std::string::npos; });
  child.send(SIGTERM);
  const Ending stopped = child.wait();
  EXPECT_EQ(stopped.code, 130) << stopped;
  EXPECT_THAT(stopped.err, AllOf(Not(HasSubstr("\x1b[2J")), HasSubstr("\\x1b[2J")));
}

TEST_F(MessagesTest, TheUsersOwnFilesAreSeenBeforeTheWork) {
  fs::create_directories(out_ + "/checkpoint");
  folder_.write("out/checkpoint/model.pt", "mine");
  refused(run({"-o", out_}), HasSubstr("checkpoint/model.pt: is no file of a run"));
  EXPECT_EQ(read_text(out_ + "/checkpoint/model.pt"), "mine");
  fs::remove_all(out_ + "/checkpoint");
  folder_.write("out/snapshots.h5", "mine");
  const Ending ending = run({"-o", out_});
  refused(ending, HasSubstr("snapshots.h5: is no result of an earlier command"));
  EXPECT_THAT(ending.err, Not(HasSubstr("of grains")));
  EXPECT_EQ(read_text(out_ + "/snapshots.h5"), "mine");
}

TEST_F(MessagesTest, AFullDiskNamesWhatItWouldHaveWritten) {
  for (const rlim_t size : {rlim_t{0}, rlim_t{100}, rlim_t{3000}, rlim_t{20'000}}) {
    const std::string out = folder_ / ("out" + std::to_string(size));
    const Ending ending = run({"-o", out}, size);
    EXPECT_EQ(ending.code, 74) << ending;
    ASSERT_EQ(complaints(ending.err).size(), 1U) << ending;
    EXPECT_THAT(complaints(ending.err).front(),
                AllOf(HasSubstr(out), Not(HasSubstr(".part")), Not(HasSubstr("dataset"))));
    if (size <= 100) {
      EXPECT_FALSE(fs::exists(out)) << "a dead end is left";
    }
    const Ending again = holds_work(out) ? run({"-o", out, "--resume"}) : run({"-o", out});
    EXPECT_EQ(again.code, 0) << again;
  }
  Start average = workshop().average().to(folder_ / "f.h5");
  average.file_size = 2000;
  const Ending ending = finish(average);
  EXPECT_EQ(ending.code, 74) << ending;
  EXPECT_THAT(ending.err,
              AllOf(HasSubstr("grainfield: " + (folder_ / "f.h5") + ": cannot be written"),
                    Not(HasSubstr(".part"))));
}

TEST_F(MessagesTest, LeftoversOfKilledRunsDoNotHinder) {
  ASSERT_EQ(run({"-o", folder_ / "whole"}).code, 0);
  for (const char* inner : {".partial", ".partial-gone", ".checkpoint-gone"}) {
    fs::create_directories(out_ + "/" + inner + "/deep");
    folder_.write(std::string("out/") + inner + "/deep/x.h5", "half");
  }
  const Ending ending = run({"-o", out_});
  EXPECT_EQ(ending.code, 0) << ending;
  EXPECT_EQ(difference(results_in(folder_ / "whole"), results_in(out_)), "");
  EXPECT_EQ(leftovers(out_), "");
  EXPECT_FALSE(fs::exists(out_ + "/.checkpoint-gone"));
}

TEST_F(MessagesTest, PicturesThatAreMissingAreNoted) {
  fs::create_directory(folder_ / "bin");
  folder_.write("bin/gnuplot", "#!/bin/sh\ncat > /dev/null\nexit 7\n");
  fs::permissions(folder_ / "bin/gnuplot", fs::perms::owner_all);
  const std::string path = (folder_ / "bin") + ":" + std::getenv("PATH");
  const std::string why = " missing: gnuplot failed: gnuplot ended with status 7";
  for (const Command& command : {workshop().run_models(), workshop().compare(), workshop().fit()}) {
    Start start = command.to(folder_ / command.name);
    start.environment["PATH"] = path;
    const Ending ending = finish(start);
    EXPECT_EQ(ending.code, 0) << ending;
    EXPECT_THAT(ending.err, AllOf(HasSubstr("grainfield: warning: report.html: "), HasSubstr(why)))
        << command.name;
  }
}

}  // namespace
}  // namespace grainfield::coupling::testing
