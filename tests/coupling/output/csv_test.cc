// CSV text: quoting, digits, what is no number.
#include "coupling/result/csv.h"

#include <gmock/gmock.h>

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace grainfield::coupling {
namespace {

TEST(Csv, RowsHoldTextsNumbersTruthAndLists) {
  Csv out;
  out.comment("lengths in m");
  out.row("id", "x", "fixed", std::vector<std::string>{"a", "b"});
  out.row(7, 1.0 / 3, true, std::vector<double>{1e-9, 2});
  out.add(-1).add(Eigen::Vector2d(0.5, 4)).add("").add(false).end_row();
  EXPECT_EQ(out.text(),
            "# lengths in m\n"
            "id,x,fixed,a,b\n"
            "7,0.333333333,1,1e-09,2\n"
            "-1,0.5,4,,0\n");
}

TEST(Csv, QuotesWhatWouldEndACell) {
  Csv out;
  out.row("osl (eta=1, mu=0)", "the \"best\"", "two\nlines", "plain text");
  EXPECT_EQ(out.text(), "\"osl (eta=1, mu=0)\",\"the \"\"best\"\"\",\"two\nlines\",plain text\n");
}

TEST(Csv, NumbersHaveAllDigitsOnDemandAndANanHasNoSign) {
  Csv out(Csv::kAllDigits);
  out.row(1.0 / 3, -std::numeric_limits<double>::quiet_NaN(), 1e300);
  EXPECT_EQ(out.text(), "0.3333333333333333,nan,1e+300\n");
}

TEST(Csv, HeadingsCarryUnits) {
  EXPECT_EQ(csv_heading("time", "s"), "time_s");
  EXPECT_EQ(csv_heading("ratio", "1"), "ratio");
  EXPECT_EQ(csv_heading("ratio", "-"), "ratio");
}

}  // namespace
}  // namespace grainfield::coupling
