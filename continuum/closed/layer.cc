// Isotropic elastic layer of depth h on a rigid base: in the plane orthotropic_layer.h's with r = t
// = 1, in space transverse_layer.h's with equal moduli, on Flamant's and Boussinesq's solution.
#include "continuum/closed/half_space.h"
#include "continuum/closed/models.h"
#include "continuum/closed/transverse_layer.h"
#include "continuum/settings.h"

namespace grainfield::continuum {
namespace {

/// In space exp(-48) u^3 is below 1e-15 of the peak.
constexpr double kTail = 48;

std::unique_ptr<Model> make_layer(const Settings& s) {
  const double F = number_of(s, "F"), h = number_of(s, "h"), nu = number_of(s, "nu");
  const Orthotropy isotropic{1, 1};
  const OrthotropicWaves waves(isotropic, nu / (1 - nu), s.at("base") == "rough", kTail);
  if (s.at("dim") == "2") return layer_in_plane(F, h, isotropic, waves, {});
  return layer_in_space(F, h, waves, {nu, nu}, [F, nu](double x, double y, double z) {
    return boussinesq_stress(F, nu, x, y, z);
  });
}

}  // namespace

ModelInfo layer_info() {
  return {
      "layer",
      "elastic layer on a rigid base under a line load, in space a point load",
      0,
      {number("F", "N", "load at the origin, down", "Roul 5.6", 1, 0, kUnbounded),
       number("h", "m", "depth of the layer", "Roul 5.6", 1, kAboveZero, kUnbounded),
       may_be_free(
           number("nu", "-", "Poisson's ratio; sigma_yy over a smooth base does not depend on it",
                  "elasticity, plane strain", 0.3, 0, 0.5),
           0, 0.499),
       choice("base", "smooth: no shear; rough: no displacement", "Roul 5.6", {"smooth", "rough"}),
       choice("dim", "2: plane strain; 3: space", "elasticity", {"2", "3"})},
      make_layer};
}

}  // namespace grainfield::continuum
