// Piles under implicit motion through the real program: at rest beside the closed form, creeping,
// the same bits, what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "dem/snapshot/snapshot.h"
#include "tests/coupling/check_scene.h"
#include "tests/coupling/run_scene.h"

namespace grainfield::coupling {
namespace {

using testing::complaint;
using testing::Folder;
using ::testing::HasSubstr;
using testing::number;
using testing::Output;
using testing::program;
using testing::run_of;

std::string pile_case(const std::string& settling, const std::string& lattice = "") {
  return "title = \"a pile\"\nstudy = \"implicit-settling\"\n[settling]\n" + settling +
         "[lattice]\nbase_grains = 8\ngap = 0\n" + lattice + "[ensemble]\nrealizations = 1\n";
}

TEST(ImplicitSettlingRun, RestsOnItsWellsAtTheClosedForm) {
  const Folder folder;
  const Summary s = run_of(folder, pile_case(""));
  EXPECT_NO_THROW(require_documented(s));
  EXPECT_EQ(number(s, "dem.grains"), 36);
  EXPECT_EQ(number(s, "settling.at_rest"), 1);
  EXPECT_LT(number(s, "settling.normal_max_error"), 0.01);
  EXPECT_LT(number(s, "settling.horizontal_max_error"), 0.01);
  EXPECT_NEAR(number(s, "base.weight_ratio"), 1, 1e-7);
  EXPECT_EQ(number(s, "settling.row_contacts"), 0);
  // It starts without forces, comes within 1 % on the way, and stays there.
  EXPECT_GT(number(s, "settling.within_from"), 0.5);
  EXPECT_LT(number(s, "settling.within_from"), number(s, "settling.within_until"));
  EXPECT_DOUBLE_EQ(number(s, "settling.within_until"), number(s, "settling.time"));
  EXPECT_LT(number(s, "settling.balance_error"), 1e-8);
  EXPECT_GT(number(s, "settling.lost_tangential"), 0);
  EXPECT_EQ(number(s, "settling.spread_speed"), 0);
  EXPECT_THAT(std::get<std::string>(s.at("verdict.sentence")), HasSubstr("The pile is at rest"));
  const std::string page = testing::read_text(folder / "out/report.html");
  for (const char* text : {"<h2>Forces of the base disks</h2>", "<h2>Energy</h2>",
                           "<h2>Newton's method</h2>", "<h2>Creep</h2>"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
  const std::string base = testing::read_text(folder / "out/profiles.csv");
  EXPECT_EQ(std::count(base.begin(), base.end(), '\n'), 9);
  EXPECT_THAT(testing::read_text(folder / "out/history.csv"),
              HasSubstr("time,kinetic,elastic,lost_normal,lost_tangential,lost_well"));
  const std::string history = testing::read_text(folder / "out/history.csv");
  const std::string last = history.substr(history.rfind('\n', history.size() - 2) + 1);
  const std::size_t comma = last.rfind(','), other = last.rfind(',', comma - 1);
  const double h = std::stod(last.substr(comma + 1));
  const double n = std::stod(last.substr(other + 1));
  EXPECT_NEAR(n, number(s, "settling.normal_max_error"), 1e-6);
  EXPECT_NEAR(h, number(s, "settling.horizontal_max_error"), 1e-6);
}

TEST(ImplicitSettlingRun, CreepsWithoutWells) {
  const Folder folder;
  const Summary s = run_of(folder, pile_case("static_friction = 0\nmax_time = 6\n"));
  EXPECT_EQ(number(s, "settling.at_rest"), 0);
  EXPECT_GT(number(s, "settling.spread"), 0.1);
  EXPECT_GT(number(s, "settling.spread_speed"), 0.01);
  EXPECT_NEAR(number(s, "settling.time"), 6, 0.1);
  EXPECT_THAT(std::get<std::string>(s.at("verdict.sentence")),
              HasSubstr("the pile still moves: its base has spread by"));
}

// The snapshot tells what a contact can hold; a force beyond it would be a mistake to its reader.
TEST(ImplicitSettlingRun, ContactsTellTheirFriction) {
  const Folder folder;
  run_of(folder, pile_case("friction = \"coulomb\"\ncoulomb = 0.8\nstatic_friction = 0.5\n"));
  const dem::Snapshot pile =
      dem::read_snapshot(folder / "out/snapshots.h5", "/realization_000/pile");
  ASSERT_FALSE(pile.contacts.empty());
  for (const dem::Contact& c : pile.contacts) {
    EXPECT_DOUBLE_EQ(c.friction, c.j < 0 ? 1.3 : 0.8);
    EXPECT_LE(std::fabs(c.tangential_force), c.friction * c.normal_force * (1 + 1e-6));
  }
}

TEST(ImplicitSettlingRun, SameBitsAfterStops) {
  const Folder folder;
  const std::string text = pile_case("friction = \"coulomb\"\nmax_time = 4\nrest = 1e-12\n") +
                           "[output]\nreport = false\n";
  run_of(folder, text, "", "one");
  const auto one = testing::contents(folder / "one");
  EXPECT_GT(one.size(), 4U);
  const std::string run = "run " + (folder / "x.toml") + " -o " + (folder / "k") + " ";
  int stops = 0, code = 130;
  for (long at = 30; code == 130 && stops < 20; at += 37, ++stops) {
    code =
        program(run + (stops > 0 ? "--resume" : "") + " --stop-after-steps " + std::to_string(at))
            .code;
  }
  EXPECT_EQ(code, 0);
  EXPECT_GT(stops, 2);
  EXPECT_EQ(testing::contents(folder / "k"), one);
}

TEST(ImplicitSettlingCheck, RefusesWhatRunWould) {
  const auto refusal = [](const std::string& settling) { return complaint(pile_case(settling)); };
  EXPECT_EQ(refusal(""), "");
  EXPECT_THAT(refusal("relaxation = 0\n"),
              HasSubstr("x.toml:4: settling.relaxation: found 0, allowed: 0.05 to 1"));
  EXPECT_THAT(refusal("relaxation = 1.5\n"),
              HasSubstr("x.toml:4: settling.relaxation: found 1.5, allowed: 0.05 to 1"));
  EXPECT_THAT(refusal("step = -1\n"), HasSubstr("x.toml:4: settling.step: found -1, allowed: "));
  EXPECT_THAT(refusal("well = 0\n"),
              HasSubstr("x.toml:4: settling.well: found 0 with settling.static_friction 1, "
                        "allowed: above 0"));
  EXPECT_THAT(refusal("frictoin = \"none\"\n"), HasSubstr("did you mean settling.friction"));
  EXPECT_THAT(complaint(pile_case("", "slope_deg = 70\n")),
              HasSubstr("lattice.slope_deg: found 70"));
  const Folder folder;
  const Output output = program(
      "run " + folder.write("x.toml", pile_case("max_iterations = 1\ntolerance = 1e-14\n")) +
      " -o " + (folder / "out"));
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("implicit motion: no step at t = "));
  EXPECT_THAT(output.err, HasSubstr("(settling.step, settling.max_iterations)"));
}

}  // namespace
}  // namespace grainfield::coupling
