// Numbers as they stand in files.
#include "dem/shared/number.h"

#include <gtest/gtest.h>

#include <limits>

namespace grainfield::dem {
namespace {

TEST(Number, IsTheWholeText) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number("+1.5e3"), 1500);
  EXPECT_EQ(parse_number("-inf"), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(parse_number("nan").value()));
  for (const char* text : {"", "+", "-", "e", "1.5 ", " 1.5", "1.5m", "1,5", "0x10", "1e", "++1"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
}

TEST(Number, SubnormalOnesAndThoseTooSmallAreNumbers) {
  EXPECT_EQ(parse_number("4.9406564584124654e-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(parse_number("-1e-310"), -1e-310);
  EXPECT_EQ(parse_number("1e-400"), 0.0);
  EXPECT_FALSE(parse_number("1e400"));
}

TEST(Number, WholeOnesHave64Bits) {
  EXPECT_EQ(parse_integer("-9223372036854775808"), std::numeric_limits<long long>::min());
  EXPECT_EQ(parse_integer("+7"), 7);
  for (const char* text : {"", "9223372036854775808", "1.0", "7 ", "seven"}) {
    EXPECT_FALSE(parse_integer(text)) << text;
  }
}

}  // namespace
}  // namespace grainfield::dem
