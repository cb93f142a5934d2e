// The settled packing of the benchmarks, with forces in equilibrium.
#pragma once
#include <string>

#include "dem/snapshot/snapshot.h"
#include "tests/benchmarks/packing_scene.h"
#include "tests/paths.h"

namespace grainfield::test {

/// 1,000 poly-disperse disks in an open box, relaxed until the unbalanced force is far below the
/// averagings' errors.
inline const dem::Snapshot& settled_layer() {
  static const dem::Snapshot snapshot = [] {
    const auto engine = benchmarks::packing_scene(
        std::string(GRAINFIELD_CASES) + "/../tests/benchmarks/data/packing_discs_1k.csv", 0.64, 1,
        1);
    engine->set_background_damping(200);
    for (int k = 0; k < 40 && (k == 0 || engine->measure().unbalanced_force_ratio > 1e-5); ++k)
      engine->step(500);
    return engine->snapshot();
  }();
  return snapshot;
}

}  // namespace grainfield::test
