// The engine for superellipsoids.
#include "dem/engine/turning3.h"
#include "dem/motion/runge_kutta3.h"
#include "dem/shapes/superellipsoid_store.h"
#include "dem/space/kinematics3.h"
// After what it combines: three dimensions add overloads that it must see.
#include "dem/engine/combine.h"

namespace grainfield::dem {

// Compiled beside this file, in superellipsoids_runge_kutta.cc.
extern template class EngineLoop<SuperellipsoidStore, LinearLaw, RungeKuttaIntegrator<3>>;
extern template class EngineLoop<SuperellipsoidStore, PenaltyLaw, RungeKuttaIntegrator<3>>;
extern template class EngineLoop<SuperellipsoidStore, HertzEllipticLaw, RungeKuttaIntegrator<3>>;

template std::unique_ptr<Engine> engine_of<SuperellipsoidStore>(const EngineSettings& settings);

}  // namespace grainfield::dem
