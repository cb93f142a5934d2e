// What a long computation says while it lasts.
#pragma once
#include <chrono>
#include <string>

#include "coupling/run/ensemble.h"

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

/// While it lives, computations (continuum/progress.h) say on the line how far they are, some
/// seconds after each has told for the first time: "fe_cone  40 %". One at a time.
class TaskProgress {
 public:
  explicit TaskProgress(ProgressLine& line);
  ~TaskProgress();
  TaskProgress(const TaskProgress&) = delete;
  TaskProgress& operator=(const TaskProgress&) = delete;
};

/// "1:02:03", "4:05"; "?" below 0.
std::string duration_text(double seconds);
/// " 12 %  1/4 done  pour 80/6500  t 1.234 s  80 grains, 5 awake  kinetic 1.0e-03 J  unbalanced
/// 1.0e-02  4:05 left", in one line.
std::string progress_text(const EnsembleProgress& progress);

}  // namespace grainfield::coupling
