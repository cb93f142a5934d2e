// The cases of cases/, run with --quick in this process.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "coupling/case/study.h"
#include "coupling/run/study_result.h"
#include "coupling/run/summary_keys.h"
#include "tests/paths.h"

namespace grainfield::coupling::testing {

/// The result of the case file of that name, of a study without grains; every key of its summary
/// is declared.
inline StudyResult shipped(const std::string& name, const Overrides& overrides = {}) {
  const Case value = read_case(std::string(GRAINFIELD_CASES) + "/" + name, true, overrides);
  const StudyResult result = study_of(value).analyse(value, {}, 1);
  EXPECT_NO_THROW(require_documented(result.summary));
  return result;
}

inline double number(const StudyResult& result, const std::string& key) {
  return std::get<double>(result.summary.at(key));
}

inline std::string word(const StudyResult& result, const std::string& key) {
  return std::get<std::string>(result.summary.at(key));
}

}  // namespace grainfield::coupling::testing
