// `check` answers within ten seconds and 200 MB whatever it is given.
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>

#include "dem/hdf5/file.h"
#include "tests/coupling/check_scene.h"
#include "tests/coupling/reliability_cases.h"

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

// Processor time of all children of this process so far, s: the machine may be busy.
double processor_time() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
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
  refused("/dev/zero", "/dev/zero: is a device, expected a case file");
  refused(folder.write("x.toml", std::string(5'000'000, '#')), "is larger than 4 MB");
  EXPECT_LT(most_memory(), 200);
}

// A pipe without a writer would be waited for, for ever.
TEST(CheckHostile, PipesThatNobodyWritesTo) {
  const Folder folder;
  const std::string pipe = folder / "pipe.toml";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  refused(pipe, "is a pipe that nobody writes to, expected a case file");
  const std::string file = folder.write("x.toml", "study = \"pile\"\n[grains]\nfiles = [\"" + pipe +
                                                      "\"]\n[change]\ngravity = [5.0]\n");
  refused(file, "grains.files: " + pipe + ": not a regular file");
  const auto command = [&](const std::string& arguments, const std::string& what) {
    const Output out = program(arguments, "timeout 20");
    EXPECT_EQ(out.code, 2) << arguments << ": " << out.err;
    EXPECT_THAT(out.err, HasSubstr(what)) << arguments;
  };
  command("run " + pipe + " -o " + (folder / "out"), "is a pipe that nobody writes to");
  command("model flamant --points " + pipe, "is a pipe that nobody writes to");
  command("model flamant --points /dev/zero", "/dev/zero: is a device, expected a CSV file");
  command("info " + pipe, "not a regular file");
  command("average " + pipe + " -o " + (folder / "f.h5"), "not a regular file");
  command("compare " + pipe + " --model flamant -o " + (folder / "c"), "not a regular file");
  command("import --from csv " + pipe + " -o " + (folder / "s.h5"),
          "is a pipe, expected a text file");
  command("fit " + pipe + " --model osl -o " + (folder / "c"), "not a regular file");
  command(
      "model fe_osl_layer --set map=" + pipe + " --points " + folder.write("p.csv", "x,y\n0,-1\n"),
      "is a pipe or device, expected a file");
}

TEST(CheckHostile, PipesThatSomebodyWritesTo) {
  const Folder folder;
  const std::string file = folder.write("x.toml", testing::tiny_case());
  Output out = program("check /dev/stdin", "(sleep 0.3; cat " + file + "; sleep 0.3) |");
  EXPECT_EQ(out.code, 0) << out.err;
  out = program("model flamant --points /dev/stdin",
                "(printf 'x,y\\n0,'; sleep 0.5; printf '%s\\n' -1) |");
  EXPECT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("\n0,-1,"));
  // One without an end.
  out = program("check /dev/stdin", "(sleep 12; true) |");
  EXPECT_EQ(out.code, 2);
  EXPECT_THAT(out.err, HasSubstr("is a pipe that does not come to its end within 8 s"));
}

// Half a gigabyte of zeros beside the grains, in a file of 2 MB. Written piece by piece: what this
// process takes would count as its children's.
void add_ballast(const std::string& file) {
  using dem::hdf5::Handle;
  const Handle in(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const hsize_t size = 64'000'000, piece = 500'000;
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle part(H5Screate_simple(1, &piece, nullptr), H5Sclose);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(properties, 1, &piece);
  H5Pset_deflate(properties, 1);
  const Handle set(
      H5Dcreate2(in, "ballast", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, properties, H5P_DEFAULT),
      H5Dclose);
  const std::vector<double> zeros(piece);
  for (hsize_t at = 0; at < size; at += piece) {
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &at, nullptr, &piece, nullptr);
    ASSERT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, part, space, H5P_DEFAULT, zeros.data()), 0);
  }
}

// A check looks at the structure alone.
TEST(CheckHostile, GrainsInLargeFiles) {
  const Folder folder;
  const std::string pile =
      folder.write("pile.toml", testing::small_pile() + "[output]\nvtu = false\nreport = false\n");
  ASSERT_EQ(program("run " + pile + " -o " + (folder / "made")).code, 0);
  const std::string file = folder / "made/snapshots.h5";
  std::string changed = testing::small_pile();
  const std::string study = "study = \"pile\"\n";
  changed.insert(changed.find(study) + study.size(),
                 "[grains]\nfiles = [\"" + file + "\"]\n[change]\ngravity = [5.0]\n");
  const std::string again = folder.write("x.toml", changed);
  const auto check = [&] { return program("check " + again); };
  ASSERT_EQ(check().code, 0) << check().err;
  add_ballast(file);
  const double before = most_memory();
  const auto start = std::chrono::steady_clock::now();
  const Output out = check();
  const auto seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(out.code, 0) << out.err;
  EXPECT_LT(seconds, 10);
  EXPECT_LE(most_memory(), std::max(before, 200.));
}

TEST(CheckHostile, MoreGrainsThanMemory) {
  const Folder folder;
  const auto check = [&](const std::string& text, const std::string& what) {
    refused(folder.write("x.toml", text), what);
  };
  check(
      "study = \"pile\"\n[source]\ngrains = 2000000\nheight = 40\ninterval = 0.03\n[floor]\nlength "
      "= 200\n",
      "source.grains: found 2000000: 2e+06 grains take about ");
  check(
      "study = \"point-load\"\n[packing]\nkind = \"triangular\"\nsizes = \"mono\"\ncolumns = "
      "5000\nrows = 1900\n",
      "packing.columns: found 5000: 9.5e+06 grains take about 24 GB of memory in a realization, "
      "allowed: up to 4.1 GB, what a process may take here");
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
  refused("elastic-layer --set " + std::string(100'000, 'k') + "=1", "unknown key; did you mean ");
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
      "study = \"pile\"\n[source]\ngrains = 400000\nheight = 20\n[floor]\nlength = 100\n"
      "[ensemble]\nrealizations = 1000\n[sweep]\nkey = \"ensemble.seed\"\nvalues = [" +
          values + "]\n[quick.source]\ngrains = 300000\n");
  const double before = processor_time();
  const Output out = program("check " + file);
  const double seconds = processor_time() - before;
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
  for (const char* grid : {"3", "x3", "3x", "3x1", "-3x3", "3x3x1", "3x3x", "3x3x3x3"}) {
    EXPECT_THAT(average(grid), HasSubstr("expected COLUMNSxROWS, both 2 or more")) << grid;
  }
}

}  // namespace
}  // namespace grainfield::coupling
