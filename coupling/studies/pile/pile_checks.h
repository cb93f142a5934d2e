// What a pile is asked to be, checked before it is poured and while it grows.
#pragma once
#include <string>
#include <vector>

#include "coupling/studies/pile/simulation.h"
#include "dem/grains/grain_family.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// The heap that is expected of these grains: a triangle of 30 degrees at a volume fraction of 0.8.
struct ExpectedHeap {
  double height = 0, base = 0;  ///< m
};
ExpectedHeap expected_heap(double grain_area);

/// Settings that can be judged without the grains, each within the range of its key (keys.cc).
/// Throws std::invalid_argument naming the key.
void check_pile(const PileSetup& setup);
/// The source and the floor against the grains that were drawn (their largest radius, m, and the
/// area of all, m2): pour rate, height of the mouth,
/// length of the line and of the floor. Throws std::invalid_argument naming the key and the least
/// value allowed.
void check_source(const PileSetup& setup, double largest_radius, double grain_area);

/// Top of the grains at rest on others or on the floor, m; 0 without any. Grains in flight, above
/// the mouth or on a funnel's plates do not count.
double resting_top(const Snapshot& snapshot, double mouth);
/// The same, and grains that hop: slower than a fall over a quarter of their diameter. No mouth.
double pile_top(const Snapshot& snapshot);
/// Throws ComputationFailed naming source.height when grains at rest come within two of the
/// largest diameters of the mouth.
void check_mouth(const PileSetup& setup, double resting_top, double diameter);
/// Throws ComputationFailed naming source.opening when a grain has waited so long, s, for its place
/// at the top of a funnel that those before it must be stuck.
void check_not_waiting(const PileSetup& setup, double waited);
/// Throws ComputationFailed naming source.opening when a grain has not left the funnel.
void check_funnel_empty(const PileSetup& setup, const Snapshot& snapshot);
/// Throws ComputationFailed naming floor.length when the pile stands at a side wall: a grain there
/// lies higher than two and a half of the largest diameters. `share`: of the grains poured so far.
void check_walls_free(const PileSetup& setup, const Snapshot& snapshot, double diameter,
                      double share);
/// The same for a pile at rest that leans on the side walls with more than 1e-3 of its weight and
/// what three stray grains weigh, at most 5e-3 together.
void check_not_leaning(const PileSetup& setup, const Snapshot& snapshot);
/// Throws ComputationFailed naming source.length when more than a fifth of the grains found no room
/// on the pile's plateau.
void check_line_long_enough(const PileSetup& setup, int poured);

}  // namespace grainfield::dem
