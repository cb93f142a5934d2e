// The study of toy_study.cc, which no file of the toolkit knows, runs as those that ship.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupling/case/keys.h"
#include "coupling/case/study.h"
#include "coupling/result/tables.h"
#include "coupling/run/ranks.h"
#include "coupling/run/run_case.h"
#include "coupling/run/summary_keys.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::AllOf;
using testing::Folder;
using ::testing::HasSubstr;

const char* const kCase = R"(study = "toy-stack"
[stack]
width = 5
[material]
floor_friction = 0.9
[compare]
models = ["hydrostatic"]
[ensemble]
realizations = 2
)";

void run(const std::string& file, const std::string& folder,
         const std::vector<std::string>& set = {}) {
  const Case value = read_case(file, false, set);
  RunOptions options;
  options.folder = folder;
  options.note = [](const std::string&) {};
  run_case(value, Ranks(), options);
}

TEST(ToyStudy, RunsAsTheOthersDo) {
  const Folder folder;
  run(folder.write("x.toml", kCase), folder / "out");
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NEAR(std::get<double>(s.at("stack.base_force_over_weight")), 1, 1e-6);
  EXPECT_EQ(std::get<std::string>(s.at("stack.carried")), "yes");
  EXPECT_EQ(std::get<std::string>(s.at("case.study")), "toy-stack");
  EXPECT_TRUE(s.contains("stack.base_force_over_weight.standard_error"));
  // The weight above a disk is not what it carries: the flanks of close-packed hard disks lean on
  // the base (Liffman 42).
  EXPECT_GT(std::get<double>(s.at("compare.hydrostatic.rel_l2")), 0.1);
  EXPECT_EQ(std::get<std::string>(s.at("verdict.best_model")), "hydrostatic");
  EXPECT_THAT(std::get<std::string>(s.at("verdict.sentence")),
              HasSubstr("The base carries 1 ± 0 of the weight. "));
  EXPECT_THAT(testing::read_text(folder / "out/report.html"),
              AllOf(HasSubstr("Network of forces"), HasSubstr("Profiles"), HasSubstr("hydrostatic"),
                    HasSubstr("vertical force on the base over the weight")));
  const std::string text = testing::read_text(folder / "out/case.toml");
  EXPECT_THAT(text, HasSubstr("[stack]"));
  EXPECT_THAT(text, HasSubstr("width = 5\n"));
  EXPECT_THAT(text, HasSubstr("floor_friction = 0.9\n"));
  EXPECT_THAT(text, HasSubstr("tolerance = 0.001\n"));
  EXPECT_EQ(text.find("[lattice]"), std::string::npos);
  // What is written reads back to the same.
  EXPECT_EQ(write_case(read_case(folder / "out/case.toml", false, {})), text);
}

TEST(ToyStudy, IsSweptOverItsOwnKeys) {
  const Folder folder;
  run(folder.write("x.toml", std::string(kCase) + "[sweep]\nkey = \"stack.width\"\nvalues = "
                                                  "[\"3\", \"4\"]\n"),
      folder / "out");
  const Summary s = read_summary(folder / "out/summary.json");
  EXPECT_NEAR(std::get<double>(s.at("stack.base_force_over_weight.width_4")), 1, 1e-6);
  EXPECT_THAT(testing::read_text(folder / "out/report.html"), HasSubstr("base force / weight"));
}

TEST(ToyStudy, ItsKeysAreCheckedAndDocumented) {
  const Folder folder;
  const std::string file = folder.write("x.toml", kCase);
  const auto refused = [&](const std::string& set) -> std::string {
    try {
      read_case(file, false, {set});
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refused("stack.width=2"), "--set: stack.width: found 2, allowed: 3 to 100");
  EXPECT_THAT(refused("stack.widht=4"), HasSubstr("unknown key; did you mean stack.width"));
  EXPECT_THAT(refused("lattice.gap=0"), HasSubstr("has no meaning for study = \"toy-stack\""));
  EXPECT_THAT(refused("study=\"toy-stak\""), HasSubstr("did you mean toy-stack"));
  EXPECT_THAT(keys_markdown(), HasSubstr("disks in the lowest row"));
  EXPECT_THAT(keys_text("stack"), HasSubstr("Studies: toy-stack."));
  EXPECT_THAT(summary_keys_markdown(), HasSubstr("| `stack.carried` | text | yes \\| no |"));
  EXPECT_EQ(find_summary_key("stack.nobody_knows"), nullptr);
}

TEST(ToyStudy, StandsBehindThoseThatShip) {
  EXPECT_EQ(studies().back().name, "toy-stack");
  EXPECT_EQ(studies().size(), shipped_studies().size() + 1);
  EXPECT_EQ(default_study(), shipped_studies().front().name);
  EXPECT_THROW(add_study([] { return Study(); }), std::logic_error) << "too late";
  // docs/extending.md promises a page.
  const std::string text =
      testing::read_text(std::string(GRAINFIELD_SOURCES) + "/tests/coupling/run/toy_study.cc");
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 100);
}

}  // namespace
}  // namespace grainfield::coupling
