// What stands in a folder before and after an attack: results as a whole, halves, leftovers.
#pragma once
#include <algorithm>

#include "reliability_process.h"

namespace grainfield::coupling::testing {

using Contents = std::map<std::string, std::string>;

/// The lock of an output folder: it may stay, it says nothing about results.
inline bool is_lock(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.front() == '.' && name.find("lock") != std::string::npos;
}

/// The results in a folder: contents() without what is not meant to be read, the checkpoint, the
/// staging area and the lock. Empty where there is no folder.
inline Contents results_in(const std::string& folder) {
  if (!fs::is_directory(folder)) return {};
  Contents out = contents(folder);
  std::erase_if(out, [](const auto& file) {
    const fs::path name = file.first;
    return *name.begin() == "checkpoint" || *name.begin() == ".partial" || is_lock(name);
  });
  return out;
}

/// Names of what a program may leave behind only where nobody could stop it: files that are being
/// written and the staging area. The checkpoint is none of these.
inline std::string leftovers(const std::string& folder) {
  std::string out;
  if (!fs::is_directory(folder)) return out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path name = fs::relative(entry.path(), folder);
    if (*name.begin() == "checkpoint" || is_lock(name)) continue;
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
/// new run, and a summary.json stands beside its own run's files alone. "" or what is wrong.
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
    // The topmost stands for everything, a member's for its own folder.
    const std::string above = file.parent_path().string();
    const std::string folder = above.empty() ? "" : above + "/";
    const auto below = [&](const Contents& run) {
      Contents out;
      for (const auto& [other, bytes] : run) {
        if (other.rfind(folder, 0) == 0) out[other] = bytes;
      }
      return out;
    };
    const Contents& its_run = is_of(whole, name, text) ? whole : earlier;
    const std::string wrong = difference(below(its_run), below(found));
    if (!wrong.empty()) return name + " beside another run's data: " + wrong;
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
