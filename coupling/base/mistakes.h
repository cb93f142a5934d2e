// All mistakes of what a user gave, not only the first.
#pragma once
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grainfield::coupling {

/// Several mistakes, a line each.
class Mistakes : public std::invalid_argument {
 public:
  explicit Mistakes(std::vector<std::string> lines);
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

/// Collects them, each once, in the order in which they are found.
class MistakeList {
 public:
  /// Does it and keeps the std::invalid_argument that it throws.
  template <class Act>
  void attempt(const Act& act) {
    try {
      act();
    } catch (const Mistakes& e) {
      for (const std::string& line : e.lines()) add(line);
    } catch (const std::invalid_argument& e) {
      add(e.what());
    }
  }
  bool empty() const { return lines_.empty(); }
  const std::vector<std::string>& lines() const { return lines_; }
  /// Lines "FILE:12: ..." of this file in its order, before all others.
  void sort_by_line(const std::string& file);
  /// Throws std::invalid_argument for one, Mistakes for several.
  void require_none() const;

 private:
  void add(const std::string& line);
  std::vector<std::string> lines_;
};

}  // namespace grainfield::coupling
