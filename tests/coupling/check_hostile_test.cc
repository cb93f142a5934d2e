// `check` answers within ten seconds and 200 MB whatever it is given.
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>

#include "check_scene.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;

// `grainfield check ARGUMENTS`: refused with this line, soon, in little memory.
void refused(const std::string& arguments, const std::string& what,
             const std::string& prefix = "") {
  const auto start = std::chrono::steady_clock::now();
  const Output out = program("check " + arguments, "ulimit -v 4000000; " + prefix);
  const auto seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(out.code, 2) << out.err.substr(0, 1000);
  EXPECT_THAT(out.err, HasSubstr(what));
  EXPECT_EQ(std::count(out.err.begin(), out.err.end(), '\n'), 1) << out.err.substr(0, 1000);
  EXPECT_LT(seconds, 10) << arguments.substr(0, 100);
}

// The most memory that a child of this process has taken so far, MB.
double most_memory() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024e-6;
}

std::string repeated(const std::string& text, int times) {
  std::string out;
  for (int k = 0; k < times; ++k) out += text;
  return out;
}

TEST(CheckHostile, FilesWithoutEnd) {
  const Folder folder;
  refused("/dev/zero", "/dev/zero: is larger than 4 MB, expected a case file");
  refused(folder.write("x.toml", std::string(5'000'000, '#')), "is larger than 4 MB");
  EXPECT_LT(most_memory(), 200);
}

TEST(CheckHostile, KeysOfAHundredThousandParts) {
  const Folder folder;
  const std::string parts = repeated("a.", 100'000) + "a";
  const auto file = [&](const std::string& text) { return folder.write("x.toml", text); };
  refused(file("title = \"t\"\n" + parts + " = 1\n"), "x.toml:2: a key of more than 32 parts");
  refused(file("[" + parts + "]\n"), "x.toml:1: a key of more than 32 parts");
  refused(file("[[" + parts + "]]\n"), "x.toml:1: a key of more than 32 parts");
  refused(file("a = {" + parts + " = 1}\n"), "x.toml:1: a key of more than 32 parts");
  refused(file("a = " + repeated("[", 100'000) + "\n"), "more than 32 levels");
  refused(file("a = " + repeated("{a=", 100'000) + "\n"), "more than 32 levels");
  refused(file("a = [" + repeated("1,", 300'000) + "1]\n"), "more than 200000 values");
  const std::string fewer = repeated("a.", 50'000) + "a";
  refused("elastic-layer --set " + fewer + "=1", "--set: a key of more than 32 parts");
  refused("elastic-layer --set a=" + repeated("[", 50'000), "--set: lists or tables of more than");
  // Dots in texts, comments and numbers are none.
  EXPECT_EQ(complaint("# " + parts + "\ntitle = \"" + repeated("1.", 100) + "\"\n[average]\n" +
                      "depths = [" + repeated("0.5,\n", 1).substr(0, 3) + "]\n"),
            "");
  EXPECT_EQ(complaint("title = \"\"\"\n" + repeated("a.", 100) + "\\\"\"\"\"\n"), "");
  EXPECT_EQ(complaint("title = '" + repeated("a.", 100) + "\\'\n"), "");
}

TEST(CheckHostile, LongNamesAndDeepPaths) {
  const std::string name(300, 'n');
  refused(name, "no such file");
  refused(name + ".toml", "no such file");
  refused(repeated("d/", 3000) + "x.toml", "no such file");
  refused("elastic-layer", "", "GRAINFIELD_CASES=/" + name);
  refused("elastic-layer --set " + std::string(100'000, 'k') + "=1", "unknown key; nearest: ");
  refused("elastic-layer --set average.kernel=" + std::string(100'000, 'k'),
          "found a text of 100000 characters, allowed: up to 4096");
  refused("elastic-layer --set compare.models=[\\\"" + std::string(4000, 'm') + "\\\"]",
          "no model");
}

TEST(CheckHostile, ManyModelsVariantsAndValues) {
  const Folder folder;
  std::string models, variants = "[sweep]\nkey = \"variant\"\nvalues = [\"v1\"]\n", values;
  for (int k = 0; k < 10'000; ++k) {
    models += "[model.m" + std::to_string(k) + "]\nname = \"layer\"\nnu = 0.3\n";
    variants += "[variant.v" + std::to_string(k) + ".material]\nfriction = 0.5\n";
    values += (k > 0 ? ", " : "") + std::to_string(k);
  }
  refused(folder.write("m.toml", models), "found 10000 tables [model.LABEL], allowed: up to 200");
  refused(folder.write("v.toml", variants),
          "found 10000 tables [variant.NAME], allowed: up to 1000");
  refused(folder.write("s.toml", "study = \"pile\"\n[sweep]\nkey = \"ensemble.seed\"\nvalues = [" +
                                     values + "]\n"),
          "sweep.values: found 10000 entries, allowed: up to 1000");
  EXPECT_LT(most_memory(), 200);
}

// As many members as are allowed, each of which draws its grains.
TEST(CheckHostile, AThousandMembersOfAMillionGrains) {
  const Folder folder;
  std::string values;
  for (int k = 0; k < 1000; ++k) values += (k > 0 ? ", " : "") + std::to_string(k);
  const std::string file = folder.write(
      "s.toml",
      "study = \"pile\"\n[source]\ngrains = 1000000\nheight = 20\n[floor]\nlength = 100\n"
      "[ensemble]\nrealizations = 1000\n[sweep]\nkey = \"ensemble.seed\"\nvalues = [" +
          values + "]\n[quick.source]\ngrains = 900000\n");
  const auto start = std::chrono::steady_clock::now();
  const Output out = program("check " + file);
  const auto seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("GB of memory"));
  EXPECT_LT(seconds, 10);
  EXPECT_LT(most_memory(), 200);
}

TEST(CheckHostile, Threads) {
  for (const char* threads : {"0", "-1", "40000", "1025", "x", "1.5"}) {
    for (const char* command :
         {"run elastic-layer", "average x.h5", "fit x.h5", "strain a.h5:u b.h5:v -o f.h5"}) {
      const Output out = program(std::string(command) + " --threads " + threads);
      EXPECT_EQ(out.code, 2) << command;
      EXPECT_THAT(out.err,
                  HasSubstr(std::string("--threads: found ") + threads + ", allowed: 1 to 1024"))
          << command;
    }
  }
  EXPECT_THAT(program("run elastic-layer --checkpoint-seconds 1e300").err,
              HasSubstr("--checkpoint-seconds: found 1e+300, allowed: 0 to 1e+06"));
}

TEST(CheckHostile, Grids) {
  const auto average = [](const std::string& grid) {
    return program("average x.h5:a -o f.h5 --grid " + grid).err;
  };
  EXPECT_THAT(average("100000x100000"),
              HasSubstr("--grid: found 100000x100000, 1e+10 points, allowed: up to 1e+06"));
  EXPECT_THAT(average("99999999999x3"), HasSubstr("points, allowed: up to 1e+06"));
  for (const char* grid : {"3", "x3", "3x", "3x1", "-3x3", "3x3x3"}) {
    EXPECT_THAT(average(grid), HasSubstr("expected COLUMNSxROWS, both 2 or more")) << grid;
  }
}

}  // namespace
}  // namespace grainfield::coupling
