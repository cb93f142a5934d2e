// What reading a case says: for tests of what `check` refuses.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "coupling/case/case.h"
#include "coupling/case/document.h"
#include "program.h"
#include "tests/paths.h"

namespace grainfield::coupling::testing {

/// What reading says of this file; "" when it is accepted.
inline std::string complaint_of(const std::string& file, const Overrides& set = {},
                                bool quick = false) {
  try {
    read_case(file, quick, set);
  } catch (const std::invalid_argument& e) {
    const std::string what = e.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    return what;
  }
  return "";
}

/// The same of a file x.toml with this text.
inline std::string complaint(const std::string& text, const Overrides& set = {},
                             bool quick = false) {
  const Folder folder;
  const std::string file = folder.write("x.toml", text);
  const std::string what = complaint_of(file, set, quick);
  // The folder differs from run to run.
  return what.compare(0, file.size(), file) == 0 ? "x.toml" + what.substr(file.size()) : what;
}

inline Case accepted(const std::string& text, const Overrides& set = {}, bool quick = false) {
  const Folder folder;
  return read_case(folder.write("x.toml", text), quick, set);
}

/// A shipped case without a sweep for every study, by its name.
inline std::map<std::string, std::string> a_case_of_every_study() {
  std::map<std::string, std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(GRAINFIELD_CASES)) {
    const std::string file = entry.path().string();
    const Case value = read_case(file, false, {});
    if (value.sweep.key.empty()) out.emplace(value.study, file);
  }
  return out;
}

}  // namespace grainfield::coupling::testing
