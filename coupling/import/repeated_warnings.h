// Warnings of many snapshots: each kind once, and how often it came again.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace grainfield::coupling {

/// Two texts are of one kind where they differ in numbers alone.
class RepeatedWarnings {
 public:
  /// Whether the text of `snapshot` is the first of its kind, to be said; any other is counted.
  bool is_first(const std::string& snapshot, const std::string& text);
  /// A line for each kind that came again, in the order of the first ones: how many snapshots had
  /// it, the last of them and its text.
  std::vector<std::string> lines() const;

 private:
  struct Kind {
    std::size_t others = 0;
    std::string last, text;
  };
  std::map<std::string, std::size_t> places_;  // by the text without its numbers
  std::vector<Kind> kinds_;
};

}  // namespace grainfield::coupling
