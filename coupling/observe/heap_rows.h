// What both sources of heaps share: geometry of the mean heap, lines through it, its maps, and the
// rows that every realization has.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "coupling/observe/observations.h"

namespace grainfield::coupling {

/// The slopes of the mean heap and their tangents.
struct HeapSlopes {
  double left_deg = 0, right_deg = 0, mean_deg = 0;
  bool apart = false;  ///< lines end at their own flank, not at the mean one's

  double left() const;   ///< tangent of the slope that ends lines on the left
  double right() const;  ///< and on the right
};

/// Measured slopes, or setup's where it gives them. Heaps without one do not count. Throws
/// std::invalid_argument naming the keys where no heap has one.
HeapSlopes slopes_of(const FitSetup& setup, const std::vector<PileFrame>& frames);

/// The models' constants, rho g = h = 1, for heaps averaged by this kernel, its width over h.
/// Throws std::invalid_argument for a friction angle below the slopes.
HeapFacts facts_of(const FitSetup& setup, const HeapSlopes& slopes, const Kernel& kernel);

/// Empty maps on a grid over a heap with these slopes, from foot to foot.
StressMaps heap_map_grid(const HeapSlopes& slopes);

/// Depth of a point below the mean flank, over h.
double depth_below_flank(const HeapFacts& facts, double x, double y);

/// Sets out.weight_over_wedge of out.frames; where the heaps are no wedges a warning says so.
void warn_of_round_tops(Observations& out);

/// Adds a warning for heights nearer to the floor than the averaging width `width`, m, of heaps
/// that are at least `height` m high: there the average mixes in the stress continued below the
/// floor, and constants are biased.
void warn_of_low_heights(const std::vector<double>& heights, double height, double width,
                         Observations& out);

/// Adds a warning that names every heap whose height differs from the median by more than a
/// realization's does (kUnlikeHeights): one of another size, or with a stray grain.
void warn_of_unlike_heaps(const std::function<std::string(std::size_t)>& name, Observations& out);

/// Indices of the realizations that are not among `numbers` (from 1). Throws std::invalid_argument
/// "fit.leave_out: ..." for a number that there is not, or when none is left.
std::vector<std::size_t> kept_realizations(std::size_t count, const std::vector<double>& numbers);

/// Adds a warning for slopes of the setup that are more than 5 degrees off the heaps' own.
void warn_of_set_slopes(const FitSetup& setup, Observations& out);

/// Where a field of heaps is fitted.
struct HeapPlaces {
  std::vector<Eigen::Index> chosen;  ///< of its points
  std::vector<int> level;            ///< of each chosen point: index into out.data.levels
  std::vector<double> pressure;      ///< rho g h of each realization, N/m; one: the mean field
  Eigen::Index map_from = 0;         ///< points from here on are those of out.maps
};
/// Values over rho g h into out.data and out.maps, from a field on points over h. Packings that are
/// copies of an earlier one (all values equal but for rounding) are dropped with a warning: they
/// are no independent realizations. Of the mean field values without an error are left out with a
/// warning, unless none has one. `name`: of a realization. Throws as keep_complete_rows.
void take_values(const FitSetup& setup, const Field& field, const HeapPlaces& at,
                 const std::function<std::string(std::size_t)>& name, Observations& out);

}  // namespace grainfield::coupling
