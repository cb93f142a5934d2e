// Grains of a family: sizes and outlines drawn from a seed.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/grains/shape_setup.h"
#include "dem/random/random.h"

namespace grainfield::dem {

/// A grain that has been drawn and not yet placed.
struct ShapedGrain {
  Outline outline;    ///< body frame, counter-clockwise; empty: a disk
  double radius = 0;  ///< from the centroid to the farthest corner, m
  double area = 0;    ///< m2
  double angle = 0;   ///< rotation to start with, rad; 0 for disks
  /// Superellipsoids (engine.h: NewGrain); the radius is from the centre to the farthest point.
  std::array<double, 3> axes{};
  std::array<double, 2> exponents{1, 1};
  std::array<double, 4> orientation{1, 0, 0, 0};

  /// The grain at rest with its centroid at (x, y).
  NewGrain at(double x, double y, double density) const;
};

/// Throws std::invalid_argument naming the key ("shape.corners_min", "shape.outline"), what was
/// found and what is allowed.
void check_shape(const ShapeSetup& shape);

/// Draws one grain: size uniform in (1 -+ polydispersity), then corners, then its angle, uniform.
/// - rand1: n corners, n uniform in corners_min..corners_max, at parameter angles on an ellipse of
///   area pi R^2. They are independent and uniform but for one condition: neighbouring ones lie
///   between 0.6 and 1.6 mean gaps 2 pi/n apart.
/// - irregular: pentagon whose corners lie on a circle, each turned by up to a quarter of the mean
///   gap from the regular pentagon's, with the mean side asked for.
ShapedGrain draw_grain(const ShapeSetup& shape, Random& random);
/// Work of drawing one, about, over that of a RAND1 octagon: many corners are rejected often.
double draw_work(const ShapeSetup& shape);
/// A disk of this radius; draws nothing.
ShapedGrain disk_grain(double radius);

/// What bounds the time step of these grains.
GrainExtremes extremes_of(const std::vector<ShapedGrain>& grains, double density);
double largest_radius(const std::vector<ShapedGrain>& grains);
double mean_radius(const std::vector<ShapedGrain>& grains);
double total_area(const std::vector<ShapedGrain>& grains);

/// Grains side by side on a line: their bounding circles between x = left and x = right, at random
/// gaps that share what is left over, lowest points at y = bottom.
std::vector<NewGrain> side_by_side(const std::vector<ShapedGrain>& grains, double left,
                                   double right, double bottom, double density, Random& random);

}  // namespace grainfield::dem
