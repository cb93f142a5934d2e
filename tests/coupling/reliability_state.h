// What stands in a folder before and after an attack: results as a whole, halves, leftovers.
#pragma once
#include <algorithm>

#include "reliability_process.h"

namespace grainfield::coupling::testing {

using Contents = std::map<std::string, std::string>;

/// What the program keeps for itself beside results: who works in a folder, which files are its
/// own. It may stay.
inline bool is_bookkeeping(const fs::path& file) {
  const std::string name = file.filename().string();
  return name == ".results" || name.rfind(".lock", 0) == 0 || name.ends_with(".lock");
}

/// A report without the rows of times.
inline std::string without_times(const std::string& report) {
  std::istringstream lines(report);
  std::string line, kept;
  while (std::getline(lines, line)) {
    if (line.find(" (time.") == std::string::npos) kept += line + "\n";
  }
  return kept;
}

/// Finished or half-done realizations that --resume can go on from.
inline bool holds_work(const std::string& folder) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder + "/checkpoint", none)) {
    const fs::path kind = entry.path().extension();
    if (kind == ".h5" || kind == ".checkpoint") return true;
  }
  return false;
}

/// The results in a folder: contents() without times, and without what is not meant to be read, the
/// checkpoint, the staging area and the bookkeeping. Empty where there is no folder.
inline Contents results_in(const std::string& folder) {
  if (!fs::is_directory(folder)) return {};
  Contents out = contents(folder);
  for (auto& [name, text] : out) {
    if (fs::path(name).filename() == "report.html") text = without_times(text);
  }
  std::erase_if(out, [](const auto& file) {
    const fs::path name = file.first;
    const fs::path top = *name.begin();
    // The last two are what is just being removed.
    return top == "checkpoint" || top == ".partial" || top == ".partial-gone" ||
           top == ".checkpoint-gone" || is_bookkeeping(name);
  });
  return out;
}

/// A file beside its target that a kill -9 found half written: nobody could remove it.
inline bool is_orphan(const fs::path& file) {
  return file.filename().string().front() == '.' && file.extension() == ".part";
}

/// Names of what a program may leave behind only where nobody could stop it: files that are being
/// written and the staging area. The checkpoint is none of these.
inline std::string leftovers(const std::string& folder) {
  std::string out;
  if (!fs::is_directory(folder)) return out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path name = fs::relative(entry.path(), folder);
    if (*name.begin() == "checkpoint" || is_bookkeeping(name)) continue;
    if (name.filename().string().front() == '.' || name.extension() == ".part")
      out += name.string() + " ";
  }
  return out;
}

/// "" where both are the same, else the first file that differs and how.
inline std::string difference(const Contents& expected, const Contents& found) {
  for (const auto& [name, text] : expected) {
    const auto at = found.find(name);
    if (at == found.end()) return name + " is missing";
    if (at->second == text) continue;
    const auto [a, b] =
        std::mismatch(text.begin(), text.end(), at->second.begin(), at->second.end());
    return name + " differs at byte " + std::to_string(a - text.begin()) + " of " +
           std::to_string(text.size()) + ": " + std::string(a, std::min(a + 60, text.end())) +
           " | " + std::string(b, std::min(b + 60, at->second.end()));
  }
  for (const auto& [name, text] : found) {
    if (expected.count(name) == 0) return name + " is too much";
  }
  return "";
}

/// What a kill in the midst of publishing may leave: every file is whole, of the earlier or of the
/// new run, and a summary.json stands beside no other run's files; the topmost only where all of
/// its run is there. "" or what is wrong.
inline std::string mixture(const Contents& earlier, const Contents& whole, const Contents& found) {
  const auto is_of = [](const Contents& run, const std::string& name, const std::string& text) {
    const auto at = run.find(name);
    return at != run.end() && at->second == text;
  };
  for (const auto& [name, text] : found) {
    if (!is_of(earlier, name, text) && !is_of(whole, name, text))
      return name + " is neither the earlier run's nor the new one's";
    const fs::path file = name;
    if (file.filename() != "summary.json") continue;
    if (is_of(earlier, name, text) && is_of(whole, name, text)) continue;  // not of the command
    const Contents& its_run = is_of(whole, name, text) ? whole : earlier;
    const fs::path above = file.parent_path();
    for (const auto& [other, bytes] : found) {
      if (fs::path(other).parent_path() == above && !is_of(its_run, other, bytes))
        return name + " beside another run's " + other;
    }
    for (const auto& [other, bytes] : its_run) {
      if (above.empty() && found.count(other) == 0) return name + " without its " + other;
    }
  }
  return "";
}

/// Seed of a suite's random choices: printed, and GRAINFIELD_SEED repeats it.
inline unsigned attack_seed() {
  static const unsigned seed = [] {
    const char* given = std::getenv("GRAINFIELD_SEED");
    const unsigned chosen =
        given != nullptr ? static_cast<unsigned>(std::stoul(given)) : std::random_device{}();
    std::printf("reliability: GRAINFIELD_SEED=%u\n", chosen);
    return chosen;
  }();
  return seed;
}

}  // namespace grainfield::coupling::testing
