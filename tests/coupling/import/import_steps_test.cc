// Steps in several files and tables: none of their contacts or grains is lost in silence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coupling/import/step_names.h"
#include "tests/coupling/import_outcome.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::Outcome;

// A row of four disks that push each other.
class ImportSteps : public testing::ImportOfFiles {
 protected:
  std::string grains(long step) {
    return atoms(step, "",
                 "1 0 0 0.01 1\n2 0.0199 0 0.01 1\n3 0.0398 0 0.01 1\n4 0.0597 0 0.01 1\n");
  }
  std::string first(long step) { return entries(step, "1 2 -1 0\n2 3 -1 0\n"); }
  std::string second(long step) { return entries(step, "3 4 -1 0\n"); }
  static Outcome read(const std::vector<std::string>& files, bool all = false) {
    return import("liggghts", files, [&](ImportOptions& options) { options.all_steps = all; });
  }
  static std::vector<std::size_t> contacts(const Outcome& outcome) {
    EXPECT_EQ(outcome.refused, "");
    std::vector<std::size_t> out;
    for (const ImportedSnapshot& one : outcome.packings)
      out.push_back(one.snapshot.contacts.size());
    return out;
  }
  using Counts = std::vector<std::size_t>;
};

TEST_F(ImportSteps, AFileForEachStepThatASeriesLacks) {
  const std::string g = write("g.dump", grains(100) + grains(200) + grains(300));
  std::vector<std::string> files{g};
  for (const long step : {100, 200, 300})
    files.push_back(write(fmt::format("pairs_{}.dump", step), first(step)));
  for (const long step : {100, 200})
    files.push_back(write(fmt::format("more_{}.dump", step), second(step)));
  const Outcome last = read(files);
  EXPECT_EQ(contacts(last), Counts{3});
  EXPECT_EQ(last.packings.front().group, "/step_200");
  EXPECT_THAT(last.packings.front().warnings,
              Contains(HasSubstr("1 of 3 steps have not all of the tables and are left out: 300")));
  EXPECT_EQ(contacts(read(files, true)), (Counts{3, 3}));
  EXPECT_THAT(import("liggghts", files,
                     [](ImportOptions& o) {
                       o.steps = {{300, ""}};
                     })
                  .refused,
              HasSubstr("not all tables of contacts of step 300"));
}

TEST_F(ImportSteps, PartsThatShareOneStepOnly) {
  const std::string g = write("g.dump", grains(0) + grains(100));
  const std::string a = write("a.dump", first(0) + first(100)), b = write("b.dump", second(0));
  EXPECT_EQ(contacts(read({g, a, b})), Counts{3});
  // One that begins later is no continued run either.
  const std::string c = write("c.dump", second(100));
  EXPECT_EQ(contacts(read({g, a, c}, true)), Counts{3});
}

TEST_F(ImportSteps, ContinuedRunsHaveAllSteps) {
  const std::string g = write("g.dump", grains(0) + grains(100)),
                    h = write("h.dump", grains(100) + grains(200));
  const std::string a = write("a.dump", first(0) + first(100)),
                    b = write("b.dump", first(100) + first(200));
  EXPECT_EQ(contacts(read({g, h, a, b}, true)), (Counts{2, 2, 2}));
  // Two processors' files each.
  const std::string c = write("c.dump", second(0) + second(100)),
                    d = write("d.dump", second(100) + second(200));
  EXPECT_EQ(contacts(read({g, h, a, b, c, d}, true)), (Counts{3, 3, 3}));
}

TEST_F(ImportSteps, TablesOfOneStepJoinedInOneFile) {
  const std::string g = write("g.dump", grains(0) + grains(100));
  const Outcome whole =
      read({g, write("c.dump", first(0) + first(100) + second(0) + second(100))}, true);
  EXPECT_EQ(contacts(whole), (Counts{3, 3}));
  EXPECT_THAT(whole.packings.front().notes,
              Contains(HasSubstr("more than once, each time with other contacts")));
  // The second lacks a step.
  EXPECT_EQ(contacts(read({g, write("d.dump", first(0) + first(100) + second(0))}, true)),
            Counts{3});
  // A run that was continued into the same file.
  const Outcome again = read({g, write("e.dump", first(0) + first(100) + first(100))}, true);
  EXPECT_EQ(contacts(again), (Counts{2, 2}));
  EXPECT_THAT(again.packings.front().warnings, Contains(HasSubstr("the last one counts")));
}

TEST_F(ImportSteps, GrainsOfSeveralProcessors) {
  const std::string low = "1 0 0 0.01 1\n2 0.0199 0 0.01 1\n",
                    high = "3 0.0398 0 0.01 1\n4 0.0597 0 0.01 1\n";
  const std::string c = write("c.dump", first(0) + first(100));
  const std::string joined = write("g.dump", atoms(0, "", low) + atoms(0, "", high));
  const Outcome one = read({joined, write("c0.dump", first(0))});
  EXPECT_EQ(contacts(one), Counts{2});
  EXPECT_EQ(one.packings.front().snapshot.grains.size(), 4u);
  // One of them lacks the last step.
  const std::string a = write("g0.dump", atoms(0, "", low) + atoms(100, "", low)),
                    b = write("g1.dump", atoms(0, "", high));
  const Outcome lacking =
      import("liggghts", {a, b, c}, [](ImportOptions& o) { o.without_contacts = true; });
  EXPECT_EQ(contacts(lacking), Counts{2});
  EXPECT_EQ(lacking.packings.front().group, "/step_0");
}

TEST(SeriesOfFiles, GoByTheNumberThatIsTheStep) {
  const auto series = series_of_files(
      {{"c0.100.dump", {100}}, {"c0.200.dump", {200}}, {"c1.100.dump", {100}}, {"a.dump", {1, 2}}});
  EXPECT_EQ(series.at("c0.100.dump"), series.at("c0.200.dump"));
  EXPECT_NE(series.at("c0.100.dump"), series.at("c1.100.dump"));
  EXPECT_EQ(series.at("a.dump"), "a.dump");
  // Numbers of frames instead of steps.
  const auto frames = series_of_files({{"c_1.dump", {500}}, {"c_2.dump", {1000}}});
  EXPECT_EQ(frames.at("c_1.dump"), frames.at("c_2.dump"));
}

}  // namespace
}  // namespace grainfield::coupling
