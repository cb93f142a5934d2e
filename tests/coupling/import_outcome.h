// Small files imported in a test: what they give, or how they are refused.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "coupling/import/import.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling::testing {

/// What an import gives, or how it is refused.
struct Outcome {
  std::vector<ImportedSnapshot> packings;
  std::string refused;
};

class ImportOfFiles : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    return folder_.write(name, text);
  }
  static Outcome import(const std::string& format, const std::vector<std::string>& files,
                        const std::function<void(ImportOptions&)>& choose = {}) {
    ImportOptions options;
    options.format = format;
    options.files = files;
    if (choose) choose(options);
    Outcome out;
    try {
      import_snapshots(options,
                       [&](ImportedSnapshot&& one) { out.packings.push_back(std::move(one)); });
    } catch (const std::invalid_argument& e) {
      out.refused = e.what();
    }
    return out;
  }
  static Outcome csv(const std::vector<std::string>& files) { return import("csv", files); }
  static ImportedSnapshot only(const Outcome& outcome) {
    EXPECT_EQ(outcome.refused, "");
    EXPECT_EQ(outcome.packings.size(), 1u);
    return outcome.packings.empty() ? ImportedSnapshot{} : outcome.packings.front();
  }

  static std::string atoms(long step, const std::string& before, const std::string& rows = "",
                           const std::string& columns = "id x y radius mass",
                           const std::string& bounds = "ff ff ff\n0 1\n0 1\n0 1") {
    const std::string all = rows.empty() ? "1 0 0.01 0.01 1\n2 0.0199 0.01 0.01 1\n" : rows;
    return fmt::format(
        "{}ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {}\nITEM: ATOMS {}\n{}",
        before, step, std::count(all.begin(), all.end(), '\n'), bounds, columns, all);
  }
  static std::string entries(long step, const std::string& rows = "1 2 -1 0\n",
                             const std::string& columns = "id1 id2 fx fy") {
    return fmt::format(
        "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ENTRIES\n{}\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 "
        "1\nITEM: ENTRIES {}\n{}",
        step, std::count(rows.begin(), rows.end(), '\n'), columns, rows);
  }

  Folder folder_;
  const std::string grains_ = "id,x,y,radius,mass\n1,0,0.01,0.01,1\n2,0.0199,0.01,0.01,1\n";
  const std::string contacts_ = "i,j,fx,fy\n1,2,-1,0\n";
};

}  // namespace grainfield::coupling::testing
