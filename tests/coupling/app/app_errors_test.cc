// What the real program says to mistakes: exit code, one line, nothing half-written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;
using ::testing::StartsWith;
using testing::tiny_case;

// One line on stderr with these words, nothing on stdout, this exit code.
void expect_refusal(const Output& output, int code, const std::string& words) {
  EXPECT_EQ(output.code, code) << output.err;
  EXPECT_THAT(output.err, StartsWith("grainfield: "));
  EXPECT_THAT(output.err, HasSubstr(words));
  EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
  EXPECT_EQ(output.out, "");
}

// A file the size of a small snapshot file, cut in the middle.
std::string truncated(const Folder& folder) {
  const std::string file =
      folder.write("case.toml", tiny_case("[output]\nvtu = false\nreport = false\n"));
  EXPECT_EQ(program("run " + file + " -o " + (folder / "made")).code, 0);
  std::string bytes = testing::read_text(folder / "made/snapshots.h5");
  bytes.resize(bytes.size() / 2);
  return folder.write("cut.h5", bytes);
}

TEST(Errors, Usage) {
  expect_refusal(program(""), 2, "required");
  expect_refusal(program("rum x.toml"), 2, "unknown command \"rum\"; did you mean run");
  expect_refusal(program("reproduce results -o page.md"), 2, "unknown command \"reproduce\"");
  expect_refusal(program("run"), 2, "run: case is required");
  expect_refusal(program("keys materiel"), 2, "did you mean material");
  expect_refusal(program("run fit-osl-point --checkpoint-seconds -1"), 2,
                 "--checkpoint-seconds: found -1, allowed: 0 to 1e+06");
  expect_refusal(program("keys --sett"), 2, "unknown option \"--sett\"");
  const Output ended = program("info -- a.h5 --modell");
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err, ::testing::Not(HasSubstr("unknown option")));
  EXPECT_EQ(program("--help").code, 0);
  EXPECT_THAT(program("--version").out, StartsWith("grainfield "));
}

TEST(Errors, SettingsOfModels) {
  const Folder folder;
  const auto model = [&](const std::string& rest) {
    return program("model " + rest + " --points " + folder.write("p.csv", "x,y\n0,-1\n"));
  };
  expect_refusal(model("cantelaube --set phi_deg=20 --set phi_deg=30"), 2,
                 "--set: phi_deg is given twice, 20 and 30; leave one out");
  expect_refusal(model("cantelaube --set branch=plus --set beta_hat_deg=30"), 2,
                 "model cantelaube: branch = plus has no effect beside beta_hat_deg = 30");
  expect_refusal(model("cantelaube --set beta_hat_deg=1e-300"), 2,
                 "model cantelaube: beta_hat_deg = 1e-300 is out of range; allowed: 1e-06 to 90");
#ifndef __SANITIZE_ADDRESS__  // that program is built without finite elements
  expect_refusal(model("fe_osl_wedge --set columns=100000 --set rows=100000"), 2,
                 "ask for 3.6e+11 unknowns; allowed: up to 1e+07; lower columns, rows or order");
#endif
}

TEST(Errors, CaseFiles) {
  const Folder folder;
  const auto run = [&](const std::string& text) {
    return program("run " + folder.write("x.toml", text) + " -o " + (folder / "out"));
  };
  expect_refusal(run("[material]\nfrction = 1\n"), 2,
                 "x.toml:2: material.frction: unknown key; did you mean material.friction");
  expect_refusal(run("[material]\nfriction = \"x\"\n"), 2, "found \"x\" (text), expected a number");
  expect_refusal(run("[material]\nfriction = -1\n"), 2, "found -1, allowed: 0 to 10");
  expect_refusal(run("[material\n"), 2, "x.toml:1: not valid TOML");
  expect_refusal(run("[motion]\ntime_step = 1\n"), 2, "stable limit");
  expect_refusal(program("check " + (folder / "none.toml")), 2, "none.toml: no such file");
  expect_refusal(program("check " + folder.path()), 2, "is a folder");
  expect_refusal(program("check " + folder.write("y.toml", "") + " --set a.b=1"), 2,
                 "--set: a: unknown section");
  EXPECT_FALSE(testing::fs::exists(folder / "out"));
}

// Options that would be taken without a word: the last of two, or none.
TEST(Errors, NothingIsGivenTwiceOrForNothing) {
  const Folder folder;
  const std::string file =
      folder.write("x.toml", tiny_case("[output]\nvtu = false\nreport = false\n"));
  expect_refusal(program("check " + file + " --set ensemble.seed=3 --set 'ensemble.seed = 4'"), 2,
                 "--set: ensemble.seed is given twice, 3 and 4; leave one out");
  expect_refusal(program("fit x.h5 --set fit.heights=[0.3] --heights 0.4"), 2,
                 "--set: fit.heights is given twice, [0.3] and [0.4]; leave one out");
  expect_refusal(program("fit x.h5 --draws 5"), 2, "--draws requires --coverage");
  expect_refusal(program("check contact-laws --set 'sweep.values=[\"ratio_2\"]'"), 2,
                 "--set: sweep.values: found \"ratio_2\", allowed: ratio_025, ratio_1");
  ASSERT_EQ(program("run " + file + " -o " + (folder / "made")).code, 0);
  const std::string field = folder / "made/fields.h5";
  expect_refusal(
      program("compare " + field + " --model flamant --model flamant -o " + (folder / "c")), 2,
      "model flamant: found twice with the same settings, allowed: once");
  expect_refusal(
      program("compare " + field + " --model flamant --origin nan,0 -o " + (folder / "c")), 2,
      "--origin: found nan, allowed: 1e+100 m at most, either way");
}

TEST(Errors, UnreadableFile) {
  if (geteuid() == 0) GTEST_SKIP() << "root reads everything";
  const Folder folder;
  const std::string file = folder.write("x.toml", "");
  testing::fs::permissions(file, testing::fs::perms::none);
  expect_refusal(program("check " + file), 2, "cannot be read");
}

TEST(Errors, FolderThatCannotBeWritten) {
  const Folder folder;
  const std::string file = folder.write("x.toml", tiny_case());
  const std::string taken = folder.write("taken", "a file");
  expect_refusal(program("run " + file + " -o " + taken), 2, "cannot write there");
  expect_refusal(program("run " + file + " -o " + taken + "/below"), 2, "cannot write there");
  EXPECT_EQ(testing::read_text(taken), "a file");
  expect_refusal(program("run " + file + " -o /proc/grainfield"), 2, "cannot write there");
  if (geteuid() == 0) return;
  testing::fs::permissions(folder.path(),
                           testing::fs::perms::owner_read | testing::fs::perms::owner_exec);
  expect_refusal(program("run " + file + " -o " + folder.path()), 2, "no write permission");
  testing::fs::permissions(folder.path(), testing::fs::perms::owner_all);
}

TEST(Errors, Hdf5Files) {
  const Folder folder;
  const std::string cut = truncated(folder);
  expect_refusal(program("info " + cut), 2, "cut.h5");
  expect_refusal(program("average " + cut + " -o " + (folder / "f.h5")), 2, "cut.h5");
  const std::string text = folder.write("text.h5", "no HDF5 at all");
  expect_refusal(program("info " + text), 2, "text.h5");
  expect_refusal(program("compare " + text + " --model flamant -o " + (folder / "c")), 2,
                 "text.h5");
  expect_refusal(program("info " + (folder / "none.h5")), 2, "none.h5");
  expect_refusal(
      program("average " + (folder / "made/snapshots.h5") + ":nobody -o " + (folder / "f.h5")), 2,
      "nobody");
  EXPECT_FALSE(testing::fs::exists(folder / "f.h5"));
  EXPECT_FALSE(testing::fs::exists(folder / "c"));
}

TEST(Errors, Points) {
  const Folder folder;
  const auto model = [&](const std::string& text) {
    return program("model flamant --points " + folder.write("p.csv", text));
  };
  expect_refusal(model(""), 2, "p.csv: is empty, expected the header x,y");
  expect_refusal(model("x,y\n"), 2, "p.csv: holds no points");
  expect_refusal(model("x,z\n1,2\n"), 2, "p.csv:1: no column \"y\"");
  expect_refusal(model("x,y\n1,-1\n2,abc\n"), 2,
                 "p.csv:3: column y: found \"abc\", expected a number");
  expect_refusal(model("x,y\n1,-1\n2\n"), 2, "p.csv:3: too few columns");
  expect_refusal(model("x,y\n1,nan\n"), 2, "found \"nan\", expected a number");
  expect_refusal(program("model flamant --points " + (folder / "none.csv")), 2,
                 "none.csv: no such file");
  expect_refusal(program("model flamant"), 2, "--points is missing");
  const std::string kept = folder.write("kept.csv", "x,y\n0,-1\n");
  expect_refusal(program("model flamant --points " + kept + " -o " + kept), 2,
                 "is an input and would be replaced; name another file");
  expect_refusal(program("model boussinesq --points " + folder.write("q.csv", "x,y\n1,2\n")), 2,
                 "no column \"z\", expected the header x,y,z");
}

TEST(Errors, Models) {
  const Folder folder;
  const std::string points = " --points " + folder.write("p.csv", "x,y\n0,-1\n");
  expect_refusal(program("model flamand" + points), 2, "did you mean 'flamant'?");
  expect_refusal(program("model layer --set nuu=1" + points), 2, "did you mean 'nu'?");
  expect_refusal(program("model layer --set nu=1" + points), 2, "out of range");
  expect_refusal(program("model layer --set nu" + points), 2, "expected parameter=value");
  expect_refusal(program("model cantelaube --set phi_deg=95" + points), 2, "allowed: 1 to 80 deg");
  expect_refusal(program("model cantelaube --set beta_hat_deg=63" + points), 2,
                 "below 90 - phi_deg = 62 deg");
  expect_refusal(program("model osl --set mu=3" + points), 2,
                 "allowed: mu below cot(phi) = 1.88073");
  expect_refusal(program("model cantelaube_asymmetric --set left_deg=30" + points), 2,
                 "at most phi_deg = 28 deg");
}

TEST(Errors, AverageOptions) {
  const Folder folder;
  const std::string file =
      folder.write("case.toml", tiny_case("[output]\nvtu = false\nreport = false\n"));
  ASSERT_EQ(program("run " + file + " -o " + (folder / "made")).code, 0);
  const std::string start =
      "average " + (folder / "made/snapshots.h5") + ":loaded -o " + (folder / "f.h5");
  expect_refusal(program(start + " --kernel lucky"), 2, "lucy");
  expect_refusal(program(start + " --method corse_graining"), 2, "coarse_graining");
  expect_refusal(program(start + " --width -1"), 2, "--width: found -1");
  expect_refusal(program(start + " --grid 3"), 2, "--grid: found \"3\"");
  expect_refusal(program("average " + (folder / "made/snapshots.h5") +
                         ":realization_000/loaded --response -o " + (folder / "f.h5")),
                 2, "unloaded is missing");
  EXPECT_FALSE(testing::fs::exists(folder / "f.h5"));
}

TEST(Errors, ComputationThatFailsLeavesNothing) {
  const Folder folder;
  // Too short a time to come to rest.
  const std::string file = folder.write("x.toml", tiny_case());
  const Output output =
      program("run " + file + " --set rest.max_time=0.001 -o " + (folder / "new/out"));
  EXPECT_EQ(output.code, 3) << output.err;
  EXPECT_THAT(output.err, HasSubstr("rest.max_time"));
  EXPECT_FALSE(testing::fs::exists(folder / "new"));
  // Results that were there before stay as they were.
  ASSERT_EQ(program("run " + file + " -o " + (folder / "out")).code, 0);
  const auto before = testing::contents(folder / "out");
  EXPECT_EQ(program("run " + file + " --set rest.max_time=0.001 -o " + (folder / "out")).code, 3);
  EXPECT_EQ(testing::contents(folder / "out"), before);
}

}  // namespace
}  // namespace grainfield::coupling
