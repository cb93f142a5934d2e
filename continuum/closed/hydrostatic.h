// Pressure of the material above a point, under a level surface or the two flanks of a heap.
#pragma once
#include "continuum/model.h"

namespace grainfield::continuum {

/// The surface: y = level - |x| tan(slope of that side), apex at x = 0.
struct HydrostaticSetup {
  double rho_g = 1;            ///< weight of a unit volume, N/m3 (areal density: N/m2)
  double level = 0;            ///< y of the surface at x = 0, m
  double left = 0, right = 0;  ///< slopes, rad, 0 (level) to below pi/2
};

/// xx = yy = -rho_g times the depth below the surface, xy = 0; n x 3, nan above the surface.
Stresses hydrostatic_stress(const HydrostaticSetup& setup, const Points& points);

}  // namespace grainfield::continuum
