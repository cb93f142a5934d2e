// `compare` and `fit` of measurements: one physics for both, errors that are unequal or missing,
// and places in a wrong unit.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "coupling/result/tables.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Output;
using testing::program;

constexpr double kFoot = 138.56;  // mm
const std::string kHeap = " --height 0.08 --slope 30 --rho-g 15000";
const std::string kHead = "x (mm),y (mm),component,value (Pa),error (Pa)\n";

// Pressures that fall from the middle to the feet, at the height y, mm.
std::string pressures(int count, double y, const std::function<std::string(int)>& error) {
  std::string out = kHead;
  const double half = kFoot * -y / 80;
  for (int k = -count; k <= count; ++k) {
    const double x = 0.9 * half * k / count;
    const double value = 10 * -y * (1 - std::fabs(x) / half) + 20 * std::cos(k);
    out += fmt::format("{},{},pressure,{},{}\n", x, y, value, error(k));
  }
  return out;
}
std::string ten(int) { return "10"; }

std::string imported(const Folder& folder, const std::string& text, const std::string& options,
                     Output* said = nullptr) {
  const std::string field = folder / "f.h5";
  const Output out =
      program("import-field " + folder.write("m.csv", text) + kHeap + options + " -o " + field);
  EXPECT_EQ(out.code, 0) << out.err;
  if (said != nullptr) *said = out;
  return field;
}

double figure(const Summary& s, const std::string& key) {
  const auto at = s.find(key);
  if (at == s.end()) {
    ADD_FAILURE() << key << " is missing";
    return std::nan("");
  }
  return std::get<double>(at->second);
}

// The column of profiles.csv by place.
std::map<std::string, double> column(const std::string& file, const std::string& name) {
  std::istringstream lines(testing::read_text(file));
  std::map<std::string, double> out;
  std::ptrdiff_t place = -1, wanted = -1;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    if (wanted < 0) {
      const auto at = [&](const std::string& heading) {
        return std::find(cells.begin(), cells.end(), heading) - cells.begin();
      };
      place = at("x_m");
      wanted = at(name);
      continue;
    }
    const double x = std::stod(cells.at(static_cast<std::size_t>(place)));
    out[fmt::format("{:.6f}", x)] = std::stod(cells.at(static_cast<std::size_t>(wanted)));
  }
  return out;
}

// Cells are flat: what a model is at a place hangs neither on the field's name nor on the judge.
TEST(MeasuredJudges, SeeAModelAlikeWhateverTheName) {
  for (const double y : {-80.0, -40.0}) {
    const std::string text = pressures(10, y, ten);
    std::map<std::string, double> seen;
    for (const char* name : {"base", "run1"}) {
      const Folder folder;
      const std::string field =
          imported(folder, text, std::string(" --width 0.016 --name ") + name);
      ASSERT_EQ(program("compare " + field + " --model bcc -o " + (folder / "c")).code, 0);
      const Summary compare = read_summary(folder / "c/summary.json");
      for (const char* key : {"rel_l2", "chi2_per_dof", "dof"}) {
        const std::string whole = std::string("compare.bcc.") + key;
        const auto [at, fresh] = seen.emplace(whole, figure(compare, whole));
        EXPECT_EQ(at->second, figure(compare, whole)) << whole << " of " << name;
      }
      EXPECT_EQ(figure(compare, "compare.bcc.dof"), 21);  // each cell by itself
      ASSERT_EQ(program(fmt::format("fit {} --model bcc --heights {} -o {}", field, 1 + y / 80,
                                    folder / "f"))
                    .code,
                0);
      const auto of_compare = column(folder / "c/profiles.csv", "bcc_N/m"),
                 of_fit = column(folder / "f/profiles.csv", "bcc_N/m");
      EXPECT_EQ(of_fit.size(), 21);
      for (const auto& [x, value] : of_fit) {
        ASSERT_EQ(of_compare.count(x), 1) << x;
        EXPECT_NEAR(value, of_compare.at(x), 1e-5 * 1200) << x << " at " << y;
      }
    }
  }
}

// A value whose error is unknown is left out of what errors judge, and said; it does not make all
// of them unknown.
TEST(MeasuredJudges, AValueWithoutAnErrorIsLeftOut) {
  const auto verdict = [](const std::string& text) {
    const Folder folder;
    const Output out = program("compare " + imported(folder, text, "") +
                               " --model bcc --model hydrostatic -o " + (folder / "c"));
    EXPECT_EQ(out.code, 0) << out.err;
    return std::pair{out.out, read_summary(folder / "c/summary.json")};
  };
  const auto [all, summary] = verdict(pressures(10, -80, ten));
  EXPECT_THAT(all, Not(HasSubstr("left out")));
  const auto [some, with_gap] =
      verdict(pressures(10, -80, [](int k) { return k == 3 ? "" : "10"; }));
  EXPECT_THAT(some,
              HasSubstr("1 of 21 values have no error and are left out of misfit and position"));
  EXPECT_THAT(some, Not(HasSubstr("without errors")));
  EXPECT_NEAR(figure(with_gap, "verdict.position_error"), figure(summary, "verdict.position_error"),
              0.1 * figure(summary, "verdict.position_error"));
  const auto [none, without] = verdict(pressures(10, -80, [](int) { return ""; }));
  EXPECT_THAT(none, HasSubstr("One field without errors cannot distinguish models"));
  EXPECT_THAT(none, Not(HasSubstr("left out")));
}

// The values that are known well decide, as they do in the ranking: there the two models are many
// errors apart.
TEST(MeasuredJudges, ValuesCountByTheirErrors) {
  const Folder folder;
  // The layer on a smooth base under 10 N at h = 0.08 m.
  std::string text = "x (mm),component,value (N/m),error (N/m)\n";
  for (const auto& [x, value, error] : {std::tuple{-80, 11.3905312, 0.5},
                                        {-40, 62.3947944, 0.5},
                                        {-20, 98.0112474, 60.0},
                                        {0, 114.936301, 60.0},
                                        {20, 98.0112474, 60.0},
                                        {40, 62.3947944, 0.5},
                                        {80, 11.3905312, 0.5}}) {
    text += fmt::format("{},pressure,{},{}\n", x, value, error);
  }
  ASSERT_EQ(program("import-field " + folder.write("m.csv", text) +
                    " --geometry layer --height 0.08 --load 10 -o " + (folder / "f.h5"))
                .code,
            0);
  const Output out = program("compare " + (folder / "f.h5") + " --model flamant --model layer -o " +
                             (folder / "c"));
  ASSERT_EQ(out.code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("The measurement supports the finite layer, not the half plane"));
  const Summary s = read_summary(folder / "c/summary.json");
  EXPECT_NEAR(figure(s, "verdict.position"), 1, 1e-3);
  // 1/sqrt(sum step^2/error^2), of which chi2 of the other model is the mean over seven places.
  EXPECT_NEAR(figure(s, "verdict.position_error"),
              1 / std::sqrt(7 * figure(s, "compare.flamant.chi2_per_dof")), 1e-6);
}

// One place astray takes no refusal and no doubt away.
TEST(MeasuredJudges, AStrayPlaceHidesNothing) {
  const Folder folder;
  const auto scaled = [](const char* unit) {
    return pressures(10, -80, ten)
               .replace(0, kHead.size(),
                        fmt::format("x (mm),y (mm),component,value ({}),"
                                    "error (Pa)\n",
                                    unit)) +
           "500,-80,pressure,1,10\n";
  };
  const Output heavy = program("import-field " + folder.write("m.csv", scaled("kPa")) + kHeap +
                               " -o " + (folder / "f.h5"));
  EXPECT_EQ(heavy.code, 2);
  EXPECT_THAT(heavy.err, HasSubstr("of the weight above them, allowed: up to 5"));
  const Output said = program("import-field " + folder.write("m.csv", scaled("Pa")) +
                              " --height 0.08 --slope 30 --rho-g 4000 -o " + (folder / "f.h5"));
  EXPECT_THAT(said.err, HasSubstr("1 of 22 places lie outside the heap"));
  EXPECT_THAT(said.err, HasSubstr(" errors off: are the units"));
}

// A measurement of the middle alone carries what stands above the middle.
TEST(MeasuredJudges, TheDoubtIsOfTheWeightAboveThePlaces) {
  const Folder folder;
  std::string middle = kHead;
  for (int k = -5; k <= 5; ++k)
    middle += fmt::format("{},-80,pressure,{},10\n", 6 * k, 15 * (80 - 3.46 * std::abs(k)));
  Output said;
  imported(folder, middle, "", &said);
  EXPECT_EQ(said.err, "");
}

TEST(MeasuredJudges, TooFewValuesWithErrorsAreCalledThat) {
  const Folder folder;
  const std::string field =
      imported(folder, pressures(10, -80, [](int k) { return k > 7 ? "10" : ""; }), "");
  const Output out = program("fit " + field + " --model bcc -o " + (folder / "fit"));
  EXPECT_EQ(out.code, 2);
  EXPECT_THAT(out.err, HasSubstr("fit.heights: found 3 values in the heaps, needed: 10 or more; 18 "
                                 "more have no error and are left out; give every value an error"));
  EXPECT_THAT(out.err, Not(HasSubstr("between the feet")));
}

TEST(MeasuredJudges, PlacesAThousandTimesTooNarrowAreRefused) {
  const Folder folder;
  std::string text = pressures(10, -80, ten);
  text.replace(text.find("x (mm)"), 6, "x (um)");
  const Output out =
      program("import-field " + folder.write("m.csv", text) + kHeap + " -o " + (folder / "f.h5"));
  EXPECT_EQ(out.code, 2) << out.err;
  EXPECT_THAT(out.err, HasSubstr("all 21 places on the base lie within 0.000125 m of the axis, "
                                 "where the feet are at -0.139 and 0.139 m, allowed: the "
                                 "outermost 0.00415692 m or more away; correct the unit of x, "
                                 "or the height (--height, m)"));
}

}  // namespace
}  // namespace grainfield::coupling
