// Volume fraction of a heap in windows that lie inside it.
#pragma once
#include "coupling/specimen/surface.h"

namespace grainfield::coupling {

/// Area of the intersection of two convex polygons with counter-clockwise corners, m2.
double common_area(const dem::Outline& a, const dem::Outline& b);

/// Area of the grains inside a convex window (counter-clockwise corners) over the window's area.
/// Disks count as polygons of equal area with 64 corners, which is exact where the window holds
/// them whole. Throws std::invalid_argument for a window without area.
double volume_fraction(const dem::Snapshot& snapshot, const dem::Outline& window);

/// Windows of a heap. Empty where the heap is too small for them: a window keeps a grain diameter
/// off the floor and one and a half below the flanks' lines, and is four diameters wide or more.
struct HeapWindows {
  dem::Outline whole;  ///< under both flanks' lines
  dem::Outline
      centre;  ///< about the apex: 15 % of the half bases to each side, up to 60 % of the height
  dem::Outline surface_left, surface_right;  ///< along the middle of a flank, four diameters thick
};

HeapWindows windows_of(const HeapShape& heap, double diameter);

}  // namespace grainfield::coupling
