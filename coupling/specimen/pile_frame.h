// A heap in coordinates that piles of slightly different height share.
#pragma once
#include <Eigen/Core>
#include <string>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Realizations of one packing do not differ by more than this ratio of heights.
constexpr double kUnlikeHeights = 1.3;

/// Heaps that weigh so many times the wedge of their height and slopes are none: models of heaps
/// are of wedges (docs/fits.md).
constexpr double kMostOverWedge = 1.2;

/// Origin at the apex, lengths in units of the height h, inside is y < 0 down to the floor y = -1.
struct PileFrame {
  double apex_x = 0;      ///< where the flanks' lines meet, m
  double floor = 0;       ///< height of the floor, m
  double height = 0;      ///< h: highest point of the heap above the floor, m
  double half_left = 0;   ///< from the apex to where the left flank's line meets the floor, m
  double half_right = 0;  ///< the same to the right, m
  double repose_left_deg = 0, repose_right_deg = 0;  ///< slopes of the flanks; nan: too few columns
  double volume_fraction = 0;  ///< mean of the inside (windows_of().whole); where the
                               ///< heap is too small for it, of everything below the free surface
  double centre_fraction = 0, surface_fraction = 0;  ///< about the apex, and along the flanks; nan:
                                                     ///< the heap is too small
  double grain_density = 0;                          ///< mass over area of the grains, kg/m2
  double gravity = 0;                                ///< m/s2
  double diameter = 0;                               ///< mean of the grains, m
  double weight = 0;                                 ///< of the free grains, N/m
  double middle_reach = 0;   ///< from the apex: 95 % of the free grains' mass lies within, m
  double largest_piece = 1;  ///< share of the area below the surface that the largest part of the
                             ///< heap without a gap of two columns holds
  /// Grains in flight (coupling/specimen/carried.h), which are no part of the surface, the height
  /// and the volume fraction: the first with id and place, and how many; empty: none.
  std::string in_flight;

  /// rho g h, N/m: grain density times volume fraction times gravity times height.
  double pressure() const { return grain_density * volume_fraction * gravity * height; }
  /// The weight over that of a wedge of this height with these slopes, rho g h^2/2 (cot left + cot
  /// right): 1 for a pointed heap, more under a round or flat top; nan: no slope.
  double weight_over_wedge() const;
  /// Why this is no heap, with its number as a realization: "realization 3: no line fits a flank";
  /// empty: it is one.
  std::string why_not_a_heap(std::size_t number) const;
  /// From scaled coordinates to the packing's axes; n x 2, m.
  Eigen::MatrixXd to_packing(const Eigen::MatrixXd& scaled) const;
  /// Distance from the apex in half bases: -1 at the left foot, 1 at the right one.
  double in_half_bases(double x) const;
};

/// Measures a heap on its floor: the tops of the fixed grains that carry it; without such the wall
/// "floor", or the lowest grain's edge. Where the flanks have too few columns for a line
/// (heaps of a few grains), apex and feet are the middle of the highest tenth and the outermost
/// grains' edges. Throws std::invalid_argument for a 3D snapshot or one without a free grain.
PileFrame pile_frame(const dem::Snapshot& pile);

}  // namespace grainfield::coupling
