#include "coupling/elastic_constants/probed.h"

#include <algorithm>
#include <cmath>

namespace grainfield::coupling {

ProbedPacking probed_packing(const dem::StateProbes& probes) {
  ProbedPacking out;
  double sum = 0, difference = 0;
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  for (const dem::Probe& probe : probes.probes) {
    const auto of = [&](std::size_t way) {
      const dem::ProbeOutcome& o = probe.outcomes[way];
      out.gained = std::max(out.gained, o.gained);
      out.lost = std::max(out.lost, o.lost);
      out.sliding = std::max(out.sliding, o.sliding);
      return increment_of(o.gradient, probes.stress, o.stress);
    };
    const SpaceIncrement forth = of(0), back = of(1);
    sum += (forth.stress + back.stress).squaredNorm();
    difference += (forth.stress - back.stress).squaredNorm();
    out.increments.push_back(
        {0.5 * (forth.stress - back.stress), 0.5 * (forth.strain - back.strain)});
    if (probe.direction[0] == probe.direction[1]) {
      const int a = probe.direction[0] - 'x';
      const SpaceIncrement& one = out.increments.back();
      stiffness.col(a) = one.stress.diagonal() / one.strain(a, a);
    }
  }
  out.moduli = space_moduli(out.increments);
  out.nonlinear = std::sqrt(sum / difference);
  out.asymmetry =
      (stiffness - stiffness.transpose()).cwiseAbs().maxCoeff() / (stiffness.trace() / 3);
  return out;
}

}  // namespace grainfield::coupling
