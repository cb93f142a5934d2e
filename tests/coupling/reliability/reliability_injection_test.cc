// Text that wants to be run or to steer the terminal: the short form of
// reliability_injection_long_test.cc.
#include "tests/coupling/reliability_injection.h"

namespace grainfield::coupling::testing {
namespace {

// A quote, what gnuplot would run, lines, and what steers a terminal.
const Texts kWorst{kEvil[0], kEvil[5], kEvil[8], kEvil[11]};

TEST(Injection, Titles) { inject_titles({kEvil[5], kEvil[11]}); }
TEST(Injection, LabelsOfModels) { inject_labels(kWorst); }
TEST(Injection, NamesOfVariants) { inject_variants(kWorst); }
TEST(Injection, FilesAndFolders) { inject_names({kEvil[5], kEvil[11]}); }
TEST(Injection, TheEnvironment) { inject_environment({kEvil[0], "missing"}); }
TEST(Injection, WhatAMistakeEchoes) {
  inject_mistakes({kEvil[11], kEvil[14], kEvil[15], std::string(120'000, 'A')});
}

}  // namespace
}  // namespace grainfield::coupling::testing
