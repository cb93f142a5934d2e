#include "coupling/studies/sample/simulation/cell.h"

namespace grainfield::dem {
namespace {

// Below these no packing carries load (random loose ones of round grains: 0.77, 0.55).
constexpr double kLoose2 = 0.7, kLoose3 = 0.5;

Eigen::Matrix3d prescribed(const SamplePlan& p, SamplePhase phase) {
  Eigen::Matrix3d flow = Eigen::Matrix3d::Zero();
  const int last = p.dim - 1;
  if (phase == SamplePhase::compress) {
    for (int a = 0; a < p.dim; ++a) {
      if (compresses(p, a)) flow(a, a) = -p.compression_rate;
    }
  } else if (phase == SamplePhase::precompress) {
    flow(last, last) = -p.strain_rate;
  } else if (deforms(phase)) {
    const double rate = phase == SamplePhase::unload ? -p.strain_rate : p.strain_rate;
    if (shears(p)) {
      flow(0, last) = rate;
    } else {
      flow(last, last) = -rate;
    }
    if (p.deformation == "isotropic") {
      for (int a = 0; a < last; ++a) flow(a, a) = -rate;
    }
  }
  return flow;
}

}  // namespace

Eigen::Matrix3d cell_flow(const SamplePlan& p, SamplePhase phase, const Vec3& pressure,
                          double fraction, CellServo& servo) {
  Eigen::Matrix3d flow = prescribed(p, phase);
  const bool loose = fraction < (p.dim == 2 ? kLoose2 : kLoose3);
  for (int a = 0; a < p.dim; ++a) {
    if (!is_led(p, phase, a)) continue;
    // Without contacts there is nothing that a servo could go by.
    const bool free = phase == SamplePhase::compress && loose && pressure[a] < p.pressure;
    flow(a, a) = free ? -p.compression_rate : servo.rate(a, pressure[a], p.pressure);
  }
  return flow;
}

}  // namespace grainfield::dem
