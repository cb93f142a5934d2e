// Every integrator, by its word. A new one is a header beside this one and an entry in
// AnyIntegrator.
#pragma once
#include "dem/motion/gear.h"
#include "dem/motion/integrator.h"
#include "dem/motion/runge_kutta.h"
#include "dem/motion/verlet.h"
#include "dem/words/choice.h"

namespace grainfield::dem {

using AnyIntegrator = std::variant<Verlet, Gear, RungeKutta>;

struct IntegratorKind : Choice<AnyIntegrator> {
  using Choice::Choice;
  static const IntegratorKind verlet, gear,
      runge_kutta;  // for C++ callers; words come through named()

  /// Throws std::invalid_argument naming motion.integrator.
  static IntegratorKind named(const std::string& word) {
    return IntegratorKind(kind_named<AnyIntegrator>(
        "motion.integrator", word, []<class Kind>() { return AnyIntegrator(Kind{}); }));
  }
};
/// Forces see the velocities of the half step.
inline bool leaps(const IntegratorKind& kind) {
  return kind.visit([](auto k) { return decltype(k)::leaps; });
}

inline constexpr IntegratorKind IntegratorKind::verlet{AnyIntegrator(Verlet{})};
inline constexpr IntegratorKind IntegratorKind::gear{AnyIntegrator(Gear{})};
inline constexpr IntegratorKind IntegratorKind::runge_kutta{AnyIntegrator(RungeKutta{})};

}  // namespace grainfield::dem
