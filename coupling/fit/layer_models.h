// The models that are fitted to the response of a layer to a point load.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "coupling/fit/fit.h"
#include "coupling/fit/layer_sight.h"
#include "coupling/fit/model.h"
#include "coupling/fit/registry_entry.h"

namespace grainfield::coupling {

/// Models of a layer under F = 1 with h = 1, through this sight, at its places; null: their own
/// stress.
///   flamant                     isotropic half plane, no parameter
///   layer_smooth                isotropic layer on a smooth base, no parameter
///   layer_rough                 on a rough base: nu
///   orthotropic_half_plane      rho = r/sqrt(t), t (continuum/closed/orthotropic.h)
///   orthotropic_layer_smooth    the same on a smooth base
///   orthotropic_layer_rough     on a rough base: shear = E_x/(2 G sqrt t), t, nu_ratio =
///                               nu_xy/sqrt t; rho = shear - nu_ratio
///   osl_layer_absorbing, osl_layer_reflecting   eta, mu, and the width of the load
/// rho above -1 is elliptic; below 0 there are two peaks; -1 is the hyperbolic limit.
std::vector<FitModel> layer_models(std::shared_ptr<const LayerSight> sight);
std::vector<RegistryEntry> layer_entries();
/// F = 1 and h = 1.
RunFacts facts_of_layer();

/// rho of a fit of an orthotropic_* model, with its error; nan of other models.
struct Ratio {
  double value = 0, error = 0;
};
Ratio rho_of(const Fit& fit);

}  // namespace grainfield::coupling
