// Where one looks at heaps: [heap] of a case.
#pragma once
#include <vector>

namespace grainfield::coupling {

/// What is looked at in a heap. Heights are shares of its height, abscissas shares of its half
/// base.
struct HeapSetup {
  std::vector<double> heights = {0.1, 0.25, 0.5};  ///< horizontal cuts above the base
  double centre = 0.1;                             ///< |x| of the windows under the apex
  double shoulder_from = 0.15, shoulder_to = 0.4;  ///< dip: |x| of the windows beside it
  /// Heights of the window on the axis in which the stress is averaged; |x| below `centre`.
  double axis_from = 0.1, axis_to = 0.6;
};

/// Throws std::invalid_argument beginning with the key: windows that overlap or are empty.
void check_heap_windows(const HeapSetup& setup);

}  // namespace grainfield::coupling
