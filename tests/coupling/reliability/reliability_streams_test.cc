// Standard output and standard error that are full, closed, or read by nobody: every command keeps
// its results and says so by its exit code alone.
#include <gmock/gmock.h>

#include "tests/coupling/reliability_scene.h"

namespace grainfield::coupling::testing {
namespace {

using ::testing::SizeIs;

constexpr std::array kBroken{Stream::full, Stream::closed, Stream::broken};
constexpr int kStorage = 74, kPipe = 141;

struct Seen {
  Ending ending;
  Contents made;
};

// With its outputs in a fresh folder; times in messages are those of another run.
Seen tried(const Command& command, Stream out, Stream err) {
  const Folder folder;
  std::string output;
  if (command.writes == Writes::file) output = folder / "out.h5";
  if (command.writes == Writes::folder) output = folder / "out";
  Start start = command.to(output);
  start.folder = folder.path();
  start.out = out;
  start.err = err;
  Seen seen{finish(start), {}};
  if (!output.empty()) {
    seen.made = made_by(command, output);
    EXPECT_EQ(leftovers(folder.path()), "") << command.name;
    for (std::size_t at; (at = seen.ending.out.find(folder.path())) != std::string::npos;)
      seen.ending.out.erase(at, folder.path().size());
  }
  return seen;
}

void expect_holds(const Command& command) {
  const Seen normal = tried(command, Stream::collected, Stream::collected);
  ASSERT_EQ(normal.ending.signal, 0) << command.name;
  for (const Stream stream : kBroken) {
    SCOPED_TRACE(command.name + ", " + name_of(stream));
    const Seen deaf = tried(command, Stream::collected, stream);
    EXPECT_EQ(deaf.ending.signal, 0);
    EXPECT_EQ(deaf.ending.code, normal.ending.code);
    EXPECT_TRUE(deaf.ending.out == normal.ending.out) << deaf.ending.out.substr(0, 400);
    EXPECT_EQ(difference(normal.made, deaf.made), "");

    const Seen dumb = tried(command, stream, Stream::collected);
    EXPECT_EQ(dumb.ending.signal, 0);
    const bool says = !normal.ending.out.empty();
    const int unheard = stream == Stream::broken ? kPipe : kStorage;
    EXPECT_EQ(dumb.ending.code, says ? unheard : normal.ending.code) << dumb.ending;
    const std::size_t lines = complaints(normal.ending.err).size();
    EXPECT_THAT(complaints(dumb.ending.err), SizeIs(lines + (says && unheard == kStorage)))
        << dumb.ending;
    EXPECT_EQ(difference(normal.made, dumb.made), "");
  }
  const Seen neither = tried(command, Stream::full, Stream::full);
  EXPECT_EQ(neither.ending.code, normal.ending.out.empty() ? normal.ending.code : kStorage);
  EXPECT_EQ(difference(normal.made, neither.made), "") << command.name;
}

TEST(Streams, CommandsThatPrint) {
  for (const Command& command : workshop().printing()) expect_holds(command);
}

TEST(Streams, CommandsThatWrite) {
  for (const Command& command : workshop().writing()) expect_holds(command);
}

TEST(Streams, GrainsBesideClosedStreams) {
  expect_holds({"run", {"run", workshop().case_file()}, Writes::folder});
}

TEST(Streams, Mistakes) {
  for (const char* word : {"run", "check", "average", "info"})
    expect_holds({word, {word, "/nowhere/x.toml"}});
  expect_holds({"help", {"--help"}});
  expect_holds({"version", {"--version"}});
}

// What stood in a file before is not ours; half a table is worse than none.
TEST(Streams, AFileOnAFullDiskIsCutBack) {
  const Folder folder;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"keys"}, workshop().model().words, {"--help"}}) {
    for (const std::string before : {"", "kept\n"}) {
      const std::string file = folder.write("table", before);
      Start start{words, {}, folder.path(), {}};
      start.out = Stream::file;
      start.out_file = file;
      start.file_size = 512;
      const Ending ending = finish(start);
      EXPECT_EQ(ending.code, kStorage) << words.front() << ending;
      EXPECT_FALSE(complaints(ending.err).empty());
      EXPECT_EQ(read_text(file).substr(0, 400), before) << words.front();
    }
  }
}

}  // namespace
}  // namespace grainfield::coupling::testing
