// A conical heap in coordinates that heaps of slightly different height share.
#pragma once
#include <Eigen/Core>
#include <array>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// A cone is looked at in so many sectors.
inline constexpr int kConeSectors = 8;
/// That of a place about the axis.
int cone_sector(double x, double y);

/// Origin at the apex, z up, lengths over the height h: inside is z < 0 down to the floor z = -1.
struct ConeFrame {
  double apex_x = 0, apex_y = 0;  ///< of the axis: centroid of the grains, m
  double floor = 0;               ///< of the layer (layer.h), m
  double height = 0;              ///< h: highest point of the heap above the floor, m
  double foot = 0;                ///< radius at which the flank's line meets the floor, m
  double repose_deg = 0;          ///< slope of that line; nan: too few columns
  /// The same of kConeSectors equal sectors, counter-clockwise from the x axis.
  std::array<double, kConeSectors> sector_repose_deg{};
  double volume_fraction = 0;  ///< mean of the inside (see cone_frame)
  double grain_density = 0;    ///< mass over volume of the grains, kg/m3
  double gravity = 0;          ///< m/s2
  double diameter = 0;         ///< mean of the grains, m

  /// Height of the cone that the flank's line spans, m: above h where the apex is round. h where no
  /// line fits.
  double apex_height() const;
  /// rho g h, Pa: grain density times volume fraction times gravity times height.
  double pressure() const { return grain_density * volume_fraction * gravity * height; }
  /// From scaled coordinates to the packing's axes; n x 3, m.
  Eigen::MatrixXd to_packing(const Eigen::MatrixXd& scaled) const;
};

/// Measures a heap of spheres. The flank's line is least squares of height against distance from
/// the axis, through the free surface (roof.h) where that line is between 15 % and 85 % of the
/// height. The inside lies two mean diameters below that line and one above the floor; where the
/// heap is too small for it, everything below the free surface. Grains without a contact count for
/// nothing, where there are contacts. Throws std::invalid_argument for a 2D snapshot or one without
/// a free grain.
ConeFrame cone_frame(const dem::Snapshot& heap);

}  // namespace grainfield::coupling
