// The engine for superellipsoids that turn by Runge and Kutta's method: beside superellipsoids.cc,
// as the two take long to compile.
#include "dem/engine/turning3.h"
#include "dem/motion/runge_kutta3.h"
#include "dem/shapes/superellipsoid_store.h"
#include "dem/space/kinematics3.h"
// After what it combines: three dimensions add overloads that it must see.
#include "dem/engine/combine.h"

namespace grainfield::dem {

template class EngineLoop<SuperellipsoidStore, LinearLaw, RungeKuttaIntegrator<3>>;
template class EngineLoop<SuperellipsoidStore, PenaltyLaw, RungeKuttaIntegrator<3>>;
template class EngineLoop<SuperellipsoidStore, HertzEllipticLaw, RungeKuttaIntegrator<3>>;

}  // namespace grainfield::dem
