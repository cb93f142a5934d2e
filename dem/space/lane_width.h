// How many numbers side by side (lanes.h) the kernels take: chosen once a program, by what the
// processor has. Every width gives the same bits.
//
// What a new shape or law needs for lanes: its kernel in a file of its own, a template over the
// width W that reads and writes plain arrays, instantiated for GRAINFIELD_LANES alone and named in
// dem/CMakeLists.txt (pair_step.cc for shapes, contact_lanes.cc for laws); for a shape, a Batch
// with put and finish (shape.h); for a law, lanes() (law.h); or what whole rows of pairs need
// (engine/row_forces.h). Without them pairs go one by one.
#pragma once
#include <type_traits>

namespace grainfield::dem {

/// 2, 4 (AVX2) or 8 (AVX-512): the most that the processor has and the environment variable
/// GRAINFIELD_LANES allows. Throws std::invalid_argument when that is none of them.
int lane_width();
/// For tests. False, and nothing changes, where the processor or the program does not have it.
bool use_lane_width(int width);

/// run(std::integral_constant<int, lane_width()>).
template <class Run>
void with_lanes(Run run) {
  switch (lane_width()) {
#if defined(__x86_64__)
    case 8:
      return run(std::integral_constant<int, 8>{});
    case 4:
      return run(std::integral_constant<int, 4>{});
#endif
    default:
      return run(std::integral_constant<int, 2>{});
  }
}

}  // namespace grainfield::dem
