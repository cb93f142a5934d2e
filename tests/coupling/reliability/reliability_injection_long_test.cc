// Every text of reliability_injection.h in every place that takes text.
#include "tests/coupling/reliability_injection.h"

namespace grainfield::coupling::testing {
namespace {

TEST(InjectionLong, Titles) { inject_titles(kEvil); }
TEST(InjectionLong, LabelsOfModels) { inject_labels(kEvil); }
TEST(InjectionLong, NamesOfVariants) { inject_variants(kEvil); }
TEST(InjectionLong, FilesAndFolders) { inject_names(kEvil); }
TEST(InjectionLong, TheEnvironment) {
  inject_environment({kEvil[0], kEvil[1], kEvil[3], kEvil[5], kEvil[11], "missing"});
}
TEST(InjectionLong, WhatAMistakeEchoes) {
  Texts evils = kEvil;
  evils.emplace_back(120'000, 'A');
  for (const char* start : {"\x1b[31m", "[", "\"", "a.b."}) {
    std::string text(start);
    while (text.size() < 100'000) text += start;
    evils.push_back(text);
  }
  inject_mistakes(evils);
}

}  // namespace
}  // namespace grainfield::coupling::testing
