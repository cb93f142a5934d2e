// Cases through the real program, and what their summary says.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <variant>

#include "coupling/result/tables.h"
#include "coupling/run/summary_keys.h"
#include "program.h"

namespace grainfield::coupling::testing {

/// Runs a case's text into folder/out; its summary. Fails the test when the program does not end
/// with 0.
inline Summary run_of(const Folder& folder, const std::string& text,
                      const std::string& options = "", const std::string& out = "out") {
  const std::string file = folder.write("x.toml", text);
  const Output output = program("run " + file + " -o " + (folder / out) + " " + options);
  EXPECT_EQ(output.code, 0) << output.err;
  return output.code == 0 ? read_summary(folder / (out + "/summary.json")) : Summary();
}

/// A figure of a summary; nan, and the test fails, where it is not there or no number.
inline double number(const Summary& summary, const std::string& key) {
  const auto at = summary.find(key);
  if (at != summary.end()) {
    if (const auto* value = std::get_if<double>(&at->second)) return *value;
    if (const auto* whole = std::get_if<std::int64_t>(&at->second)) {
      return static_cast<double>(*whole);
    }
  }
  ADD_FAILURE() << "no number " << key;
  return std::nan("");
}

/// A file, perhaps a long one, holds a text.
inline bool says(const std::string& file, const std::string& text) {
  return read_text(file).find(text) != std::string::npos;
}

}  // namespace grainfield::coupling::testing
