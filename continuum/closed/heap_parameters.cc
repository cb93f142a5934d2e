// Parameters that all heaps share.
#include "continuum/closed/models.h"
#include "continuum/settings.h"

namespace grainfield::continuum {

Parameter friction_angle() {
  return number("phi_deg", "deg", "friction angle, and slope of a heap at its angle of repose",
                "Roul 4.2", 28, 1, 80);
}

Parameter weight() {
  return number("rho_g", "N/m3", "weight of a unit volume (N/m2 with an areal density)",
                "force balance", 1, kLeastScale, kMostScale);
}

}  // namespace grainfield::continuum
