// The figures of the sources that this program's studies are measured against.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coupling/reproduce/results.h"

namespace grainfield::coupling {

/// One figure. It is a number with the range that counts as the source's, or a word.
struct SourceFigure {
  std::string source;              ///< "Roul 3.1"
  std::string what;                ///< "angle of repose, point source"
  std::string unit;                ///< "deg"; empty: a pure number or a word
  std::string study;               ///< whose result it comes from
  std::string theirs;              ///< as the source says it
  double low = 0, high = 0;        ///< numbers: theirs with its reading error
  std::vector<std::string> words;  ///< words: those of ours that agree
  /// Numbers: ours; nothing where the study was not run.
  std::function<std::optional<Measured>(const Results&)> number;
  /// Words: ours, and what supports it.
  std::function<std::optional<std::string>(const Results&)> word;
  /// Ratios: how far from 1 the source's lies, which is what it says; 0: the value itself counts.
  double effect = 0;
  /// What must be known of ours, in the row's last words; "" where nothing.
  std::function<std::string(const Results&)> note = nullptr;
  /// What ours says where no result has it; "": "not run".
  std::string missing = "";
};

/// In the order of the page.
const std::vector<SourceFigure>& source_figures();

/// "agrees", "differs by 1.2 deg (3.1 standard errors)", ... by the rule that the page states:
/// a number agrees when the source's range and ours +- 2 standard errors meet; it says nothing when
/// 2 standard errors are wider than `kTooWide` of the source's value (of `effect` where given), or
/// with one realization.
std::string agreement(const SourceFigure& figure, const Measured& ours);
inline constexpr double kTooWide = 0.5;
inline constexpr const char* kWideSpread = "spread too wide to tell";

}  // namespace grainfield::coupling
