// A family of grain shapes.
#pragma once
#include <string>
#include <tuple>
#include <vector>

namespace grainfield::dem {

/// What a grain looks like. Outlines have their centroid at the origin and lie at random angles.
struct ShapeSetup {
  std::string kind = "rand1";   ///< disk | rand1 (corners at random on a circle or ellipse, Roul) |
                                ///< regular | irregular (pentagons) | outline (given)
  double radius = 0.00275;      ///< m; disk; or of the circle that the corners lie on (rand1 with
                                ///< axis_ratio: ellipse of equal area)
  double polydispersity = 0.3;  ///< sizes uniform in (1 -+ this) times radius or side; below 1
  int corners_min = 6;          ///< rand1, regular: corners, uniform between these two; 3 or more
  int corners_max = 8;
  double axis_ratio = 1;  ///< rand1: major over minor axis of the ellipse that carries the corners
  double side = 0;        ///< m; irregular: mean length of a side; 0: of the regular pentagon whose
                          ///< corners lie on `radius`
  std::vector<double> outline;  ///< outline: x1, y1, x2, y2, ... in units of `radius`, convex

  auto members() const {
    return std::tie(kind, radius, polydispersity, corners_min, corners_max, axis_ratio, side,
                    outline);
  }
};

}  // namespace grainfield::dem
