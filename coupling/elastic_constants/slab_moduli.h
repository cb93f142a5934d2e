// Elastic constants of the slabs of a layer from small strains, with errors, and the table that
// finite elements read them from (continuum/moduli_by_depth.h).
//
// In the plane strains tell four constants, C11, C13, C33, C44 (3: up). A material in space that
// does not strain across the plane has a fifth one, which no stress in the plane depends on:
// nu_h = 0 is taken, which is stable wherever the four are.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "continuum/closed/transverse.h"
#include "coupling/elastic_constants/space_symmetry.h"
#include "dem/run/probe_record.h"

namespace grainfield::coupling {

/// Pa, in the plane N/m: of transverse isotropy, and of isotropy.
struct SlabConstants {
  enum Place { e_h, e_v, nu_h, nu_v, g_v, young, poisson, count };
  std::array<double, count> values{};
  /// Root of sum |sigma - C eps|^2 over sum |sigma|^2.
  double residual_transverse = 0, residual_isotropic = 0;

  continuum::TransverseModuli transverse() const;
  continuum::TransverseModuli isotropic() const;
};

/// Least squares of all increments. `dim` 2: of xx, yy, xy, up along y. Throws
/// std::invalid_argument where the strains do not tell the constants.
SlabConstants slab_constants(const SpaceIncrements& increments, int dim);

/// The central differences of probes forth and back.
SpaceIncrements increments_of(const dem::StateProbes& probes);

/// One slab with the standard errors of its constants: over realizations, or over the strips of
/// one.
struct SlabModuli {
  double depth = 0;  ///< of its middle below the surface, m
  double thickness = 0;
  std::array<double, SlabConstants::count> mean{}, error{};
  double residual_transverse = 0, residual_isotropic = 0;  ///< means
};

/// `strips` of one slab, each with constants of its own: the mean is that of `whole`, the error
/// that of the strips' mean; nan for one strip.
SlabModuli slab_of_strips(const SlabConstants& whole, const std::vector<SlabConstants>& strips);
/// The mean of one slab over realizations; the error is nan for one.
SlabModuli slab_of_realizations(const std::vector<SlabConstants>& realizations);

/// The file that finite elements read with `moduli=`, header depth,E_v,E_h,nu_h,nu_v,G_v or,
/// isotropic, depth,E,nu: a row at the middle of each slab, and the outer slabs' constants again at
/// the surface and at `depth`, m. Comment lines have the errors. `slabs`: from the surface
/// downwards. Throws std::invalid_argument for slabs in another order or none.
std::string moduli_table(const std::vector<SlabModuli>& slabs, double depth, bool isotropic);

}  // namespace grainfield::coupling
