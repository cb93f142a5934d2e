#include "coupling/base/printable.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;

TEST(Printable, OrdinaryTextStays) {
  const std::string text = "rough=layer:\tν = 0.3, größer, 砂\n\xF0\x9F\x8F\x96";
  EXPECT_EQ(printable(text), text);
}

TEST(Printable, WhatSteersATerminalIsWrittenOut) {
  EXPECT_EQ(printable("a\x1b[31mb\r\x07\x7f"), "a\\x1b[31mb\\x0d\\x07\\x7f");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xC2\x9B"
                      "2J"),
            "\\xc2\\x9b2J");                                  // CSI in one character
  EXPECT_EQ(printable("x\xE2\x80\xAEgpj"), "x\\u{202e}gpj");  // right to left
  EXPECT_EQ(printable("a\xE2\x80\xA8"
                      "b"),
            "a\\u{2028}b");  // another line end
}

TEST(Printable, BytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\xFF\xC0\xAF"), "\\xff\\xc0\\xaf");           // overlong
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond Unicode
  EXPECT_EQ(printable("\xE2\x82"), "\\xe2\\x82");                    // cut
}

TEST(Printable, NothingRawIsLeftOfRandomBytes) {
  std::mt19937 bits(7);
  for (int round = 0; round < 2000; ++round) {
    std::string text;
    for (int k = 0; k < 40; ++k) text += static_cast<char>(bits());
    const std::string shown = printable(text);
    EXPECT_EQ(printable(shown), shown);
    for (const char c : shown) {
      const auto byte = static_cast<unsigned char>(c);
      EXPECT_TRUE(byte >= 0x20 || c == '\n' || c == '\t') << round;
      EXPECT_NE(byte, 0x7f);
    }
  }
}

TEST(OneLine, LongTextKeepsBothEnds) {
  const std::string line = one_line(
      "case.toml:3: title: found \"" + std::string(120000, 'x') + "\", allowed: less", 600);
  EXPECT_LT(line.size(), 700u);
  EXPECT_THAT(line, HasSubstr("case.toml:3: title"));
  EXPECT_THAT(line, HasSubstr(" bytes ...]"));
  EXPECT_THAT(line, HasSubstr("allowed: less"));
}

TEST(OneLine, CutsNoCharacterAndBreaksNoLine) {
  std::string text;
  for (int k = 0; k < 3000; ++k) text += "ν\n";
  for (std::size_t most = 100; most < 112; ++most) {
    const std::string line = one_line(text, most);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_EQ(printable(line), line) << most;  // broken characters would be written out
  }
}

}  // namespace
}  // namespace grainfield::coupling
