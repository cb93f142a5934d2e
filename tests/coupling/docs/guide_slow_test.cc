// docs/guide.md and docs/tutorial-point-load.md: every command in them runs, in order, and says
// what the page says; so does the guide's script of Python, where the module is. The commands of
// docs/experiments.md run on tables that models fill.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "coupling/result/tables.h"
#include "tests/coupling/guide_scene.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::Output;
using testing::program;
using ::testing::StartsWith;

struct Page {
  std::string said;    ///< what its commands wrote to standard output
  std::string shown;   ///< its blocks ``` without a language: output of its commands
  std::string python;  ///< its script
  int commands = 0;
};

/// Runs the indented commands of a page in order; its block ```toml is the file that its first line
/// names ("# heap.toml"), a block ```csv NAME the file NAME as printed. A run gets `smaller` too.
Page read_and_run(const Folder& folder, const std::string& page, const std::string& smaller = "") {
  Page out;
  std::istringstream text(testing::read_text(test::kDocs + page));
  std::string line, block, kind;
  const std::string start = "    grainfield ";
  while (std::getline(text, line)) {
    if (line.compare(0, 3, "```") == 0) {
      if (kind == "toml") folder.write(block.substr(2, block.find('\n') - 2), block);
      if (kind == " ") out.shown += block;
      if (kind == "python") out.python += block;
      if (kind.starts_with("csv ")) folder.write(kind.substr(4), block);
      // The language stands in a block's first line; its last line has none.
      kind = kind.empty() ? (line.size() > 3 ? line.substr(3) : " ") : "";
      block.clear();
    } else if (!kind.empty()) {
      block += line + "\n";
    } else if (line.compare(0, start.size(), start) == 0) {
      ++out.commands;
      std::string words = line.substr(start.size());
      if (words.starts_with("run ")) words += smaller;
      const Output done = program(words, "cd " + folder.path() + " &&");
      EXPECT_EQ(done.code, 0) << line << "\n" << done.err;
      out.said += done.out;
    }
  }
  return out;
}

/// Lines of the page's blocks of output that its commands did not print.
std::vector<std::string> lines_missing(const Page& page) {
  std::vector<std::string> out;
  std::istringstream shown(page.shown);
  for (std::string line; std::getline(shown, line);) {
    if (page.said.find(line) == std::string::npos) out.push_back(line);
  }
  return out;
}

double figure(const Summary& s, const std::string& key) { return std::get<double>(s.at(key)); }

TEST(Guide, EveryCommandSaysWhatThePageSays) {
  const Folder folder;
  const Page page = read_and_run(folder, "guide.md");
  EXPECT_EQ(page.commands, 11);
  EXPECT_TRUE(lines_missing(page).empty())
      << fmt::format("{}", fmt::join(lines_missing(page), "\n"));
  EXPECT_THAT(page.shown, HasSubstr("One pile cannot distinguish models"));
  EXPECT_THAT(page.shown, HasSubstr("The grains support osl, cantelaube_zero and bcc, which "));
  // The measurement was made of osl: its constants come back, and bcc does not stand.
  const Summary measured = read_summary(folder / "measured/summary.json");
  EXPECT_NEAR(figure(measured, "fit.osl.eta"), 0.74, 3 * figure(measured, "fit.osl.eta.error"));
  EXPECT_NEAR(figure(measured, "fit.osl.mu"), -0.31, 3 * figure(measured, "fit.osl.mu.error"));
  EXPECT_EQ(std::get<std::string>(measured.at("fit.osl.supported")), "yes");
  EXPECT_EQ(std::get<std::string>(measured.at("fit.bcc.supported")), "no");
  EXPECT_NEAR(figure(measured, "fit.bcc.aic_behind"), 960, 0.5);
  EXPECT_THAT(page.shown, HasSubstr("| osl   | eta      | 0.735 ± 0.010  |"));
  // The three disks of the page are at rest, and their floor carries them.
  EXPECT_THAT(page.said, HasSubstr("three: 2D, 3 grains (0 fixed), 4 contacts (2 with walls)"));
  EXPECT_THAT(page.said, HasSubstr("weight carried by walls and fixed grains: 1\n"));
  EXPECT_THAT(testing::read_text(folder / "three.csv"),
              HasSubstr("tension positive\nx (m),y (m),"));
  // The lines of the table on the page are those of the file.
  const std::string table = testing::read_text(folder / "samples/measured.csv");
  for (const char* line : {"x (mm),component,value (Pa),error (Pa)\n", "-120,pressure,199.7,4.1\n",
                           "-120,shear,-74.1,1.5\n"}) {
    EXPECT_THAT(testing::read_text(test::kDocs + "guide.md"), HasSubstr(line));
    EXPECT_THAT(table, HasSubstr(line));
  }
  EXPECT_THAT(page.python, HasSubstr("gf.fit("));
  const std::string build = testing::fs::path(GRAINFIELD_PROGRAM).parent_path().string();
  if (std::system(("ls " + build + "/python/grainfield/_core*.so > /dev/null 2>&1").c_str()) != 0) {
    return;  // the module is not built here
  }
  folder.write("guide.py", page.python);
  const std::string python =
      "cd " + folder.path() + " && PYTHONPATH=" + build +
      "/python MPLBACKEND=Agg /usr/bin/python3 -W ignore guide.py > python.out 2>&1";
  EXPECT_EQ(std::system(python.c_str()), 0) << testing::read_text(folder / "python.out");
  EXPECT_THAT(testing::read_text(folder / "python.out"), HasSubstr("cannot be distinguished"));
}

TEST(Tutorial, PointLoadRunsAsOnThePage) {
  const Folder folder;
  // Two layers of half the size, without moduli, and two models: the page's own take a minute.
  const Page page = read_and_run(folder, "tutorial-point-load.md",
                                 " --set ensemble.realizations=2 --set packing.width=0.08 "
                                 "--set packing.depth=0.03 --set load.probe_strain=0 "
                                 "--set rest.unbalanced_force_ratio=1e-5 "
                                 "--set 'compare.models=[\"boussinesq\",\"layer\"]'");
  EXPECT_EQ(page.commands, 3);
  EXPECT_THAT(page.said, HasSubstr("half space"));
}

// What `./bootstrap demo` says at its end leads to one report, which has the pictures. One layer
// instead of sixteen.
TEST(Demo, LeadsToOneReport) {
  const std::string root = test::kDocs + std::string("../");
  std::string script = testing::read_text(root + "bootstrap");
  const std::size_t begin = script.find("\n  demo)\n"), end = script.find(";;", begin);
  ASSERT_NE(end, std::string::npos);
  script = std::regex_replace(script.substr(begin, end - begin), std::regex("\\\\\n *"), " ");
  std::smatch command;
  ASSERT_TRUE(
      std::regex_search(script, command, std::regex("/grainfield (run .*)-o results/demo")));
  const Folder folder;
  const std::string run =
      std::regex_replace(command[1].str(), std::regex("realizations=16"), "realizations=1");
  const Output done = program(run + "-o " + (folder / "demo"), "cd " + root + " &&");
  ASSERT_EQ(done.code, 0) << done.err;
  const std::string said = done.out + script;
  const std::regex page("[^ ]*report\\.html");
  const std::vector<std::string> reports(std::sregex_token_iterator(said.begin(), said.end(), page),
                                         std::sregex_token_iterator());
  EXPECT_THAT(reports, ::testing::ElementsAre(folder / "demo/report.html"));
  EXPECT_THAT(testing::read_text(folder / "demo/report.html"), HasSubstr("<img "));
}

// A table for a command of experiments.md: positions over h or in mm, made up.
std::string table(bool heap, double height, double slope, double rho_g,
                  const std::string& unit = "kPa") {
  std::string out =
      fmt::format("x ({}),component,value ({}),error ({})\n", heap ? "mm" : "h", unit, unit);
  for (int k = -8; k <= 8; ++k) {
    const double share = k / 9.0;
    const double foot = height / std::tan(slope * std::numbers::pi / 180);
    const double value =
        heap ? 0.8e-3 * rho_g * height * (1 - std::fabs(share)) : 0.8 - 0.1 * std::abs(k);
    out += fmt::format("{},pressure,{},{}\n", heap ? 1000 * share * foot : share * 2, value,
                       heap ? 0.02 * value + 0.001 : 0.05);
  }
  return out;
}

TEST(Experiments, EveryCommandRuns) {
  const Folder folder;
  folder.write("geng.csv", table(false, 1, 30, 0, "F/h"));
  folder.write("serero_dense.csv", table(false, 1, 30, 0, "F/h2"));
  folder.write("mueggenburg.csv", table(false, 1, 30, 0, "F/h2"));
  folder.write("smid_novosad.csv", table(true, 0.6, 32.6, 15000));
  folder.write("vanel_point.csv", table(true, 0.08, 30, 15000));
  folder.write("apex.csv", "x,y,z\n0,0,-1\n");
  const Page page = read_and_run(folder, "experiments.md");
  EXPECT_EQ(page.commands, 16);
  // The dips of cone_fpa, cone_fpa_levy, cone_osl by its default and with two mu, and cone_bcc, as
  // in the table.
  std::vector<double> dips;
  const std::regex ratio("# dip_ratio = ([0-9.]+)");
  for (auto at = std::sregex_iterator(page.said.begin(), page.said.end(), ratio);
       at != std::sregex_iterator(); ++at) {
    dips.push_back(std::round(100 * (1 - std::stod((*at)[1]))));
  }
  EXPECT_THAT(dips, ::testing::ElementsAre(41, 75, 26, 20, 30, 0));
}

}  // namespace
}  // namespace grainfield::coupling
