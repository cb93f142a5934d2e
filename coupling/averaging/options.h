// What is averaged, and how.
#pragma once
#include <string>
#include <vector>

namespace grainfield::coupling {

struct AverageOptions {
  std::string method = "coarse_graining";  ///< coarse_graining | particle_centre | area_exact
  /// coarse_graining: lucy | gaussian | heaviside; particle_centre and area_exact: circle | square
  /// (in 3D the sphere and the cube; area_exact then counts volumes)
  std::string kernel = "lucy";
  /// m. coarse_graining: w of the kernel (lucy ends at 2 w, gaussian at 3 w, heaviside at w);
  /// particle_centre and area_exact: radius of the circle or half the side of the square.
  double width = 0;
  /// coarse_graining: true carries the force of a wall or fixed grain straight on into the wall, so
  /// that the stress reaches the wall's value at the wall and traction_* vanishes in the layer;
  /// false ends the branch at the contact point and gives traction_* there (Weinhart et al. 2012).
  bool extend_into_walls = true;
  /// coarse_graining: "open" leaves the fields smeared over the free surface, where they obey the
  /// balance of forces; "normalised" divides by the share of the kernel inside the packing, so that
  /// they keep their values up to the surface, and the balance ends one range below it.
  std::string free_surface = "open";
  int least_grains = 3;                 ///< fewer grains than this in the support: nan there
  int threads = 1;                      ///< the bits do not depend on it
  std::vector<std::string> quantities;  ///< by name (quantities.h); empty: all
};

}  // namespace grainfield::coupling
