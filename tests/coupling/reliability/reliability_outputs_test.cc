// Where an output may go: links are followed, what is no file or no folder is left alone, and what
// a run leaves is its own alone.
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>

#include "tests/coupling/reliability_scene.h"

namespace grainfield::coupling::testing {
namespace {

using ::testing::HasSubstr;

// The name itself, not what a link points to.
struct stat stat_of(const std::string& name) {
  struct stat out {};
  EXPECT_EQ(lstat(name.c_str(), &out), 0) << name;
  return out;
}

// A device of our own like /dev/null or /dev/full. Root could destroy the machine's, so those are
// tried by nobody else.
std::string device(const Folder& folder, const std::string& name, unsigned minor_number) {
  const std::string path = folder / name;
  if (mknod(path.c_str(), S_IFCHR | 0666, makedev(1, minor_number)) == 0) return path;
  return geteuid() == 0 ? "" : "/dev/" + name;
}

void make_socket(const std::string& path) {
  const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(descriptor);
}

TEST(Outputs, DevicesPipesAndSocketsAreRefused) {
  const Folder folder;
  std::vector<std::string> places{folder / "pipe", folder / "socket"};
  ASSERT_EQ(mkfifo(places[0].c_str(), 0600), 0);
  make_socket(places[1]);
  places.push_back(device(folder, "null", 3));
  places.push_back(device(folder, "full", 7));
  std::erase(places, "");
  // A link to a device is the device.
  fs::create_symlink(folder / "pipe", folder / "link");
  places.push_back(folder / "link");
  for (const std::string& place : places) {
    const struct stat before = stat_of(place);
    for (const Command& command : workshop().writing()) {
      const Ending ending = finish(command.to(place), 60);
      EXPECT_EQ(ending.code, 2) << command.name << " -o " << place << ": " << ending;
      ASSERT_FALSE(complaints(ending.err).empty()) << command.name;
      EXPECT_THAT(complaints(ending.err).back(), HasSubstr(place)) << command.name;
      struct stat after {};
      ASSERT_EQ(lstat(place.c_str(), &after), 0) << command.name << " removed " << place;
      ASSERT_EQ(after.st_mode, before.st_mode) << command.name << " replaced " << place;
      ASSERT_EQ(after.st_ino, before.st_ino) << command.name << " replaced " << place;
    }
  }
  EXPECT_EQ(leftovers(folder.path()), "");
}

TEST(Outputs, ALinkStaysAndItsTargetIsReplaced) {
  for (const Command& command : workshop().writing()) {
    SCOPED_TRACE(command.name);
    const Folder folder;
    const bool wants_folder = command.writes == Writes::folder;
    const std::string there = "far/target" + command.ending();
    const std::string target = folder / there, link = folder / ("link" + command.ending());
    fs::create_directory(folder / "far");
    if (wants_folder) {
      fs::create_directory(target);
    } else {
      folder.write(there, "old");
    }
    fs::create_symlink(there, link);
    const Ending ending = finish(command.to(link));
    ASSERT_EQ(ending.code, 0) << ending;
    ASSERT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(fs::read_symlink(link), there);
    EXPECT_EQ(wants_folder, fs::is_directory(target));
    const Contents made = made_by(command, target);
    EXPECT_FALSE(made.empty());
    if (!wants_folder) {
      EXPECT_TRUE(made.at("file") != "old");
    }
    EXPECT_EQ(leftovers(folder.path()), "");
  }
}

// Refused or followed, but never replaced by what it should have pointed to.
TEST(Outputs, ADanglingLinkStaysALink) {
  for (const Command& command : workshop().writing()) {
    SCOPED_TRACE(command.name);
    const Folder folder;
    const std::string there = "target" + command.ending(), target = folder / there,
                      link = folder / ("link" + command.ending());
    fs::create_symlink(there, link);
    const Ending ending = finish(command.to(link));
    EXPECT_TRUE(fs::is_symlink(link));
    if (ending.code == 0) {
      EXPECT_FALSE(made_by(command, target).empty());
    } else {
      EXPECT_EQ(ending.code, 2) << ending;
      EXPECT_FALSE(complaints(ending.err).empty());
      EXPECT_FALSE(fs::exists(target));
    }
    EXPECT_EQ(leftovers(folder.path()), "");
  }
}

TEST(Outputs, ALoopOfLinksIsRefused) {
  const Folder folder;
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  for (const Command& command : workshop().writing()) {
    const Ending ending = finish(command.to(folder / "a"));
    EXPECT_EQ(ending.code, 2) << command.name << ": " << ending;
    EXPECT_TRUE(fs::is_symlink(folder / "a")) << command.name;
  }
}

TEST(Outputs, PermissionsOfAFileStay) {
  for (const Command& command : workshop().writing()) {
    if (command.writes != Writes::file) continue;
    for (const mode_t mode : {0600, 0664}) {
      const Folder folder;
      const std::string file = folder.write("out" + command.ending(), "old");
      ASSERT_EQ(chmod(file.c_str(), mode), 0);
      EXPECT_EQ(finish(command.to(file)).code, 0) << command.name;
      EXPECT_EQ(stat_of(file).st_mode & 07777U, mode) << command.name;
      EXPECT_TRUE(read_text(file) != "old") << command.name;
    }
  }
}

// The user's own files stay, whatever they are called.
TEST(Outputs, ARunOverAnotherStudyLeavesNothingOfIt) {
  const Folder folder;
  const std::string out = folder / "out";
  const auto run = [&](const std::string& text, const std::string& to) {
    const std::string file = folder.write("x.toml", text);
    const Ending ending = finish({{"run", file, "-o", to}, {}, "", {}});
    EXPECT_EQ(ending.code, 0) << ending;
  };
  const std::vector<TinyStudy>& studies = tiny_studies();
  std::map<std::string, Contents> alone;
  for (const TinyStudy& study : studies) {
    run(study.text, folder / study.name);
    alone[study.name] = results_in(folder / study.name);
  }
  const Contents own{
      {"notes.txt", "mine"}, {"data.csv", "1,2"}, {"mine.vtu", "x"}, {"plots/a.png", "y"}};
  fs::create_directories(out + "/plots");
  for (const auto& [name, text] : own) folder.write("out/" + name, text);
  for (const std::size_t k : {0, 2, 1, 3, 0}) {
    run(studies[k].text, out);
    Contents expected = alone.at(studies[k].name);
    expected.insert(own.begin(), own.end());
    ASSERT_EQ(difference(expected, results_in(out)), "") << studies[k].name;
  }
}

TEST(Outputs, FoldersOfAnOldSweepGoButNotWhatTheUserPutThere) {
  const Folder folder;
  const std::string out = folder / "out";
  const auto run = [&](const std::string& values) {
    const std::string text =
        small_layer("[sweep]\nkey = \"material.friction\"\nvalues = [" + values + "]\n");
    const Ending ending = finish({{"run", folder.write("x.toml", text), "-o", out}, {}, "", {}});
    EXPECT_EQ(ending.code, 0) << ending;
  };
  run("0.2, 0.3");
  folder.write("out/friction_0.2/notes.txt", "mine");
  run("0.4");
  EXPECT_FALSE(fs::exists(out + "/friction_0.3"));
  EXPECT_TRUE(fs::exists(out + "/friction_0.4/summary.json"));
  EXPECT_EQ(difference({{"notes.txt", "mine"}}, results_in(out + "/friction_0.2")), "");
}

}  // namespace
}  // namespace grainfield::coupling::testing
