#include "coupling/case/shipped_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "continuum/installed.h"
#include "continuum/model.h"

namespace grainfield::coupling {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> files_of(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    if (at->path().extension() == extension) files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> there() { return files_of(cases_folder(), ".toml"); }

}  // namespace

fs::path cases_folder() {
  if (const char* given = std::getenv("GRAINFIELD_CASES")) return given;
  std::error_code error;
  for (const fs::path& prefix : continuum::installed_prefixes()) {
    const fs::path installed = prefix / "share/grainfield/cases";
    if (fs::is_directory(installed, error)) return installed;
  }
  return GRAINFIELD_CASES_DIR;
}

std::vector<fs::path> shipped_cases() {
  std::vector<fs::path> files = there();
  if (files.empty()) {
    throw std::invalid_argument(fmt::format(
        "{}: holds no case files; set GRAINFIELD_CASES to their folder", cases_folder().string()));
  }
  return files;
}

std::vector<fs::path> shipped_samples() {
  const fs::path folder = cases_folder() / "samples";
  std::vector<fs::path> files = files_of(folder, ".h5");
  for (const fs::path& table : files_of(folder, ".csv")) files.push_back(table);
  if (files.empty()) {
    throw std::invalid_argument(fmt::format(
        "{}: holds no sample files; set GRAINFIELD_CASES to the folder above", folder.string()));
  }
  return files;
}

std::string find_case(const std::string& name) {
  std::error_code error;
  const fs::path given(name);
  // What is there and no folder: a file, a pipe.
  const auto readable = [&](const fs::path& path) {
    return fs::exists(path, error) && !fs::is_directory(path, error);
  };
  if (readable(given)) return name;
  const bool plain = given.extension() != ".toml";
  if (plain && readable(name + ".toml")) return name + ".toml";
  const std::string wanted = plain ? given.filename().string() : given.stem().string();
  std::vector<std::string> names;
  for (const fs::path& file : there()) {
    names.push_back(file.stem().string());
    if (names.back() == wanted && !given.has_parent_path()) return file.string();
  }
  if (fs::is_directory(given, error)) {
    throw std::invalid_argument(name + ": is a folder, expected a case file");
  }
  if (names.empty()) throw std::invalid_argument(name + ": no such file");
  const std::string near = continuum::misspelt(wanted, names);
  throw std::invalid_argument(
      fmt::format("{}: no such file, and no shipped case{} (grainfield cases)", name,
                  near.empty() ? "" : "; did you mean " + near + "?"));
}

}  // namespace grainfield::coupling
