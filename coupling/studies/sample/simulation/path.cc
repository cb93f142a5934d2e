#include "coupling/studies/sample/simulation/path.h"

namespace grainfield::dem {

bool compresses(const SamplePlan& p, int axis) {
  return p.compression == "isotropic" || axis == p.dim - 1;
}

bool is_led(const SamplePlan& p, SamplePhase phase, int axis) {
  const int last = p.dim - 1;
  if (deforms(phase)) {
    if (p.deformation == "axial") return axis != last;
    return shears(p) && p.constant == "stress" && axis == last;
  }
  if (phase == SamplePhase::drop) return false;
  if (phase == SamplePhase::precompress || phase == SamplePhase::settle || probes(phase))
    return false;
  return compresses_to_pressure(p) && compresses(p, axis);
}

bool any_led(const SamplePlan& p, SamplePhase phase) {
  for (int a = 0; a < p.dim; ++a) {
    if (is_led(p, phase, a)) return true;
  }
  return false;
}

double strain_at(const SamplePlan& p, double time) {
  const double ramp = p.boundary == "walls" ? p.ramp_time : 0;
  if (time >= ramp) return p.strain_rate * (time - 0.5 * ramp);
  const double x = time / ramp;
  return p.strain_rate * ramp * (x * x * x - 0.5 * x * x * x * x);
}

long steps_to(const SamplePlan& p, double strain, double time_step) {
  // Up to its last digit, so that a strain which is a whole number of steps takes no step more.
  const double enough = strain * (1 - 1e-12);
  const auto reached = [&](long n) {
    return strain_at(p, static_cast<double>(n) * time_step) >= enough;
  };
  long low = 0, high = 1;
  while (!reached(high)) high *= 2;
  while (high - low > 1) {
    const long middle = low + (high - low) / 2;
    (reached(middle) ? high : low) = middle;
  }
  return high;
}

double strain_in(const SamplePlan& p, SamplePhase phase, double time, double time_step) {
  const double passed = strain_at(p, time);
  if (phase != SamplePhase::unload) return passed;
  return strain_at(p, static_cast<double>(steps_to(p, p.strain, time_step)) * time_step) - passed;
}

}  // namespace grainfield::dem
