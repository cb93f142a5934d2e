// What of a polygon bounds the time step of a law.
#pragma once

namespace grainfield::dem {

enum class EdgeMeasure {
  none,       ///< the force does not grow with the width of a contact
  steepness,  ///< 2 e/a: edge over the half of its distance from the centroid (edge_steepness)
  width,      ///< 2 e/R: edge over the half of the radius of equal area (edge_width)
};

}  // namespace grainfield::dem
