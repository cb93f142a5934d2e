// What a long computation says while it lasts.
#pragma once
#include <chrono>
#include <string>

namespace grainfield::coupling {

/// One line that is rewritten on a terminal; elsewhere a line every few seconds.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  /// `text` makes the line, where one is due.
  template <class Text>
  void show(Text text) {
    if (due()) put(text());
  }
  void note(const std::string& text);
  void end();

 private:
  bool due();
  void put(const std::string& line);

  bool quiet_, terminal_, open_ = false;
  std::chrono::steady_clock::time_point last_;
};

/// While it lives, finite elements that solve for more than a few seconds say how far they are:
/// "fe_cone  40 % of the load". One at a time.
class SolverProgress {
 public:
  SolverProgress();
  ~SolverProgress();
  SolverProgress(const SolverProgress&) = delete;
  SolverProgress& operator=(const SolverProgress&) = delete;
};

}  // namespace grainfield::coupling
