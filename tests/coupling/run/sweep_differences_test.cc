// Whether the members of a sweep differ: Welch's t, Holm's correction, the sentence.
#include "coupling/run/sweep_differences.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coupling/run/sweep.h"
#include "coupling/statistics/spread.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::vector<OverviewColumn> kColumns{{"repose (deg)", "repose.mean_deg", ""},
                                           {"dip", "dip.difference", "dip.standard_error"},
                                           {"word", "verdict.best_model", ""}};

Summary member(double repose, double repose_error, double dip, double dip_error, int n = 8) {
  return {{"repose.mean_deg", repose},
          {"repose.mean_deg.standard_error", repose_error},
          {"dip.difference", dip},
          {"dip.standard_error", dip_error},
          {"verdict.best_model", std::string("bcc")},
          {"ensemble.realizations", static_cast<std::int64_t>(n)}};
}

// Two layers under 3 and 300 N, whose responses are one in F/h.
TEST(MemberProfiles, AreDrawnInEachMembersOwnUnits) {
  Case value;
  value.sweep.key = "load.force";
  value.sweep.values = {"3", "300"};
  std::vector<StudyResult> results;
  for (const double load : {3.0, 300.0}) {
    Profile p;
    p.name = p.key = "base";
    p.x = Eigen::Vector3d(-0.1, 0, 0.1);
    p.mean = load / 0.2 * Eigen::Vector3d(0.25, 0.75, 0.25);
    p.error = 0 * p.mean;
    StudyResult one;
    one.comparison = without_models({p}, scale_of_load(load, 0.2));
    results.push_back(std::move(one));
  }
  const Picture picture = member_profiles(value, {{"a", value}, {"b", value}}, results);
  EXPECT_THAT(picture.program, HasSubstr("set xlabel \"x / h\""));
  EXPECT_THAT(picture.program, HasSubstr("(F/h)\""));
  const auto first = picture.program.find("0 0.75"), second = picture.program.rfind("0 0.75");
  EXPECT_NE(first, std::string::npos);
  EXPECT_NE(first, second);
}

// Both members are nearest to one model, which is drawn once; the other model is not drawn.
TEST(MemberProfiles, HaveTheNearestModelOfAMember) {
  Case value;
  value.sweep.key = "load.force";
  value.sweep.values = {"3", "300"};
  std::vector<StudyResult> results;
  for (const double load : {3.0, 300.0}) {
    Profile p;
    p.name = p.key = "base";
    p.x = Eigen::Vector3d(-0.1, 0, 0.1);
    p.mean = load / 0.2 * Eigen::Vector3d(0.25, 0.75, 0.25);
    ModelProfiles near, far;
    near.key = "rough", near.label = "rough=layer (base=rough)", near.values = {0.8 * p.mean};
    far.key = far.label = "flamant", far.values = {0.5 * p.mean};
    StudyResult one;
    one.comparison = compare({p}, {far, near}, scale_of_load(load, 0.2));
    one.comparison.judgement.best = "rough";
    results.push_back(std::move(one));
  }
  const std::string program = member_profiles(value, {{"a", value}, {"b", value}}, results).program;
  EXPECT_THAT(program, HasSubstr("rough (load.force = 3)"));
  EXPECT_THAT(program, HasSubstr("0 0.6"));
  EXPECT_THAT(program, ::testing::Not(HasSubstr("rough (load.force = 300)")));
  EXPECT_THAT(program, ::testing::Not(HasSubstr("flamant")));
}

// Student's t with 4 degrees of freedom has a closed distribution.
TEST(Welch, ClosedFormForEqualSpreads) {
  for (const double t : {0.1, 1.0, 2.776, 8.0}) {
    const double w = 1 + t * t / 4, p = 1 - 0.75 * t / std::sqrt(w) * (1 - t * t / (12 * w));
    EXPECT_NEAR(welch_p_value(t * std::sqrt(2.0) * 0.3, 0.3, 3, 0.3, 3), p, 1e-12);
    EXPECT_NEAR(welch_p_value(-t * std::sqrt(2.0) * 0.3, 0.3, 3, 0.3, 3), p, 1e-12);
  }
  // One exact mean: the freedom is that of the other.
  const double t = 1.3, w = 1 + t * t / 4;
  EXPECT_NEAR(welch_p_value(t * 0.2, 0.2, 5, 0, 9),
              1 - 0.75 * t / std::sqrt(w) * (1 - t * t / (12 * w)), 1e-12);
}

TEST(Welch, SaysNothingWithoutErrorsOrWithFewRealizations) {
  EXPECT_TRUE(std::isnan(welch_p_value(1, 0, 8, 0, 8)));
  EXPECT_TRUE(std::isnan(welch_p_value(1, 0.1, 2, 0.1, 8)));
  EXPECT_TRUE(std::isnan(welch_p_value(1, std::nan(""), 8, 0.1, 8)));
}

// Ensembles of the same mean and unlike spread: 5 % of the p are below 0.05, and after Holm's
// correction at most 5 % of the families of ten have one below.
TEST(Welch, HoldsItsLevel) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto sample = [&](int n, double spread) {
    std::vector<double> values(n);
    for (double& v : values) v = spread * normal(random);
    return spread_of(values);
  };
  constexpr int kFamilies = 2000, kFigures = 10;
  std::vector<OverviewColumn> columns;
  for (int f = 0; f < kFigures; ++f) columns.push_back({"f", "f" + std::to_string(f), ""});
  int below = 0, families = 0;
  for (int k = 0; k < kFamilies; ++k) {
    Summary one{{"ensemble.realizations", std::int64_t{8}}}, other = one;
    for (const OverviewColumn& column : columns) {
      const Spread a = sample(8, 1), b = sample(8, 4);
      one[column.key] = a.mean;
      one[column.error()] = a.standard_error;
      other[column.key] = b.mean;
      other[column.error()] = b.standard_error;
    }
    const auto found = sweep_differences(columns, {one, other});
    ASSERT_THAT(found, SizeIs(kFigures));
    bool any = false;
    for (const auto& d : found) {
      below += d.p_value < 0.05 ? 1 : 0;
      any = any || d.p_holm < 0.05;
      EXPECT_GE(d.p_holm, d.p_value);
    }
    families += any ? 1 : 0;
  }
  EXPECT_NEAR(below / static_cast<double>(kFamilies * kFigures), 0.05, 0.007);
  EXPECT_LT(families / static_cast<double>(kFamilies), 0.065);
  EXPECT_GT(families, 0);
}

TEST(SweepDifferences, AreAgainstTheFirstMember) {
  const auto found = sweep_differences(
      kColumns,
      {member(30, 0.5, 0.1, 0.02), member(34, 0.6, 0.1, 0.03), member(29, 0.5, 0.2, 0.02)});
  ASSERT_THAT(found, SizeIs(4));  // two figures have errors, two members follow
  EXPECT_EQ(found[0].key, "repose.mean_deg");
  EXPECT_EQ(found[0].member, 1U);
  EXPECT_DOUBLE_EQ(found[0].difference, 4);
  EXPECT_DOUBLE_EQ(found[0].error, std::hypot(0.5, 0.6));
  EXPECT_DOUBLE_EQ(found[1].difference, -1);
  EXPECT_NEAR(found[3].difference, 0.1, 1e-15);
  // Holm: the smallest p times 4, the next times 3; never falling.
  EXPECT_NEAR(found[0].p_holm, 4 * found[0].p_value, 1e-15);
  EXPECT_NEAR(found[3].p_holm, std::max(found[0].p_holm, 3 * found[3].p_value), 1e-15);
  EXPECT_EQ(found[2].p_holm, 1);
  EXPECT_THAT(sweep_differences(kColumns, {member(30, 0.5, 0, 1, 2), member(9, 0.5, 0, 1, 2)}),
              SizeIs(0));
}

TEST(SweepDifferences, InOneSentence) {
  const std::vector<std::string> names{"friction = 0.3", "friction = 0.9"};
  EXPECT_EQ(differences_sentence(sweep_differences(kColumns, {member(30, 0.5, 0.1, 0.02),
                                                              member(34, 0.6, 0.1, 0.03)}),
                                 names),
            "Different at 5 % (Welch's t over realizations, Holm's correction for 2 comparisons): "
            "repose (deg) of friction = 0.9 is above that of friction = 0.3 by 4 ± 0.78 (p = "
            "0.00017).");
  EXPECT_THAT(
      differences_sentence(
          sweep_differences(kColumns, {member(30, 0.5, 0.1, 0.02), member(30.5, 0.6, 0.1, 0.03)}),
          names),
      HasSubstr("Nothing differs at 5 % (Welch's t over realizations, Holm's correction for "
                "2 comparisons). The least p is that of repose (deg) of friction = 0.9 against "
                "friction = 0.3: +0.5 ± 0.78, p = 0.5"));
  EXPECT_EQ(differences_sentence({}, names), "");
}

// Three packings of another friction: the run says it, the report and the summary hold it.
TEST(SweepDifferences, AreInReportAndSummaryOfARun) {
  const testing::Folder folder;
  const std::string file = folder.write(
      "x.toml", testing::tiny_case("[output]\nvtu = false\n[sweep]\nkey = \"material.friction\"\n"
                                   "values = [0.3, 0.6]\n"));
  const auto run = testing::program("run " + file + " -o " + (folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("at 5 % (Welch's t over realizations"));
  EXPECT_THAT(run.out, HasSubstr(". Not compared, without errors: peaks.\n"));
  EXPECT_THAT(testing::read_text(folder / "out/report.html"), HasSubstr("Between the members"));
  const std::string summary = testing::read_text(folder / "out/summary.json");
  EXPECT_THAT(summary, HasSubstr("\"sweep.sentence\": "));
  EXPECT_THAT(summary, HasSubstr("\"sweep.p_value.response."));
}

}  // namespace
}  // namespace grainfield::coupling
