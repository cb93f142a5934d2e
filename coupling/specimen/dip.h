// The dip of the base pressure under the apex, and how sure it is.
#pragma once
#include <string>
#include <vector>

#include "coupling/specimen/pile_frame.h"
#include "coupling/specimen/setup.h"
#include "coupling/statistics/spread.h"

namespace grainfield::coupling {

/// Mean vertical pressure of one pile in windows of its base, in units of its rho g h, from the
/// forces on the base themselves (no smearing).
struct BaseWindows {
  double centre = 0;    ///< |x| below heap.centre half bases
  double shoulder = 0;  ///< on both sides, |x| from heap.shoulder_from to heap.shoulder_to
};
BaseWindows base_windows(const dem::Snapshot& pile, const PileFrame& frame, const HeapSetup& setup);

/// The dip over an ensemble.
struct Dip {
  double centre = 0, shoulder = 0;  ///< means, rho g h
  double window_ratio = 0;          ///< centre over shoulder
  Spread difference;                ///< shoulder - centre of every pile, rho g h: above 0 is a dip
  std::string verdict;  ///< "dip", "peak", "neither" or "undecided" (below 3 realizations)
};
/// A dip where the difference is above 0, a peak where it is below, at 5 % for both together
/// (two-sided, Student's t); neither in between.
Dip judge_dip(const std::vector<BaseWindows>& piles);
/// What is found, and the numbers: a line each, for people.
std::vector<std::string> dip_lines(const Dip& dip);

}  // namespace grainfield::coupling
