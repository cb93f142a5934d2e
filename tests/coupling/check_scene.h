// What reading a case says: for tests of what `check` refuses.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "coupling/case/case.h"
#include "coupling/case/keys.h"
#include "coupling/case/study.h"
#include "program.h"

namespace grainfield::coupling::testing {

/// What reading says of this file; "" when it is accepted.
inline std::string complaint_of(const std::string& file, const Overrides& set = {},
                                bool quick = false) {
  try {
    read_case(file, quick, set);
  } catch (const std::invalid_argument& e) {
    return e.what();  // of several mistakes a line each
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

/// A small case of a study, as text.
inline std::string small_case(const std::string& study) {
  std::string out = "study = \"" + study + "\"\n";
  if (study == "wedge") {
    out += "[compare]\nmodels = [\"fe_mohr_coulomb_wedge\", \"cantelaube\"]\n";
  }
  const bool grains = find_study(study)->has_grains();
  if (grains) out += "[ensemble]\nrealizations = 2\n";
  if (grains && section_applies("source", study)) out += "[source]\ngrains = 200\n";
  return out;
}

}  // namespace grainfield::coupling::testing
