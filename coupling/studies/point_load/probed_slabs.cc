#include "coupling/studies/point_load/probed_slabs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coupling/studies/point_load/layer_probe.h"
#include "dem/shared/computation_failed.h"

namespace grainfield::coupling {
namespace {

// The even part of the stress changes over the odd one, as in probed_packing().
double nonlinear_share(const dem::StateProbes& probes) {
  double sum = 0, difference = 0;
  for (const dem::Probe& probe : probes.probes) {
    const Eigen::Matrix3d forth = probe.outcomes[0].stress - probes.stress;
    const Eigen::Matrix3d back = probe.outcomes[1].stress - probes.stress;
    sum += (forth + back).squaredNorm();
    difference += (forth - back).squaredNorm();
  }
  return std::sqrt(sum / difference);
}

}  // namespace

std::optional<ProbedSlabs> probe_slabs(const dem::Snapshot& layer, const dem::Materials& materials,
                                       double height, const SlabProbing& how,
                                       const std::function<bool(double)>& go_on) {
  std::vector<dem::Slab> slabs = dem::slabs_of(layer, height, how.slabs);
  std::reverse(slabs.begin(), slabs.end());
  slabs.insert(slabs.begin(), dem::Slab{slabs.back().low, slabs.front().high});
  dem::LayerProber prober(layer, materials, height, how.strain, slabs, how.strips);
  if (!prober.settle(go_on)) return std::nullopt;
  std::vector<dem::StateProbes> parts(prober.parts());
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k].stress = prober.stress_before(k);
  ProbedSlabs out;
  for (int n = 0; n < prober.count_here(); ++n) {
    const auto outcomes = prober.probe_parts(n, go_on);
    if (!outcomes) return std::nullopt;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const dem::ProbeOutcome& one = (*outcomes)[k];
      dem::add_outcome(parts[k], dem::LayerProber::direction(n, layer.dim), n, one);
      out.contacts_changed = std::max({out.contacts_changed, one.gained, one.lost, one.sliding});
    }
  }
  out.nonlinear = nonlinear_share(parts.front());
  const std::size_t per_slab = how.strips > 1 ? static_cast<std::size_t>(how.strips) + 1 : 1;
  for (std::size_t s = 0; s < slabs.size(); ++s) {
    std::vector<SlabConstants> constants;
    try {
      for (std::size_t k = 0; k < per_slab; ++k) {
        constants.push_back(slab_constants(increments_of(parts[s * per_slab + k]), layer.dim));
      }
    } catch (const std::invalid_argument& failure) {
      throw ComputationFailed(failure.what());
    }
    const SlabConstants whole = constants.front();
    if (per_slab > 1) constants.erase(constants.begin());
    SlabModuli one = slab_of_strips(whole, constants);
    one.depth = height - 0.5 * (slabs[s].low + slabs[s].high);
    one.thickness = slabs[s].high - slabs[s].low;
    if (s == 0) {
      out.whole = one;
    } else {
      out.slabs.push_back(one);
    }
  }
  return out;
}

std::vector<SlabModuli> over_realizations(const std::vector<std::vector<SlabModuli>>& all) {
  std::vector<SlabModuli> out;
  for (std::size_t s = 0; !all.empty() && s < all.front().size(); ++s) {
    std::vector<SlabConstants> constants;
    double depth = 0, thickness = 0;
    for (const std::vector<SlabModuli>& one : all) {
      SlabConstants& c = constants.emplace_back();
      c.values = one[s].mean;
      c.residual_transverse = one[s].residual_transverse;
      c.residual_isotropic = one[s].residual_isotropic;
      depth += one[s].depth / static_cast<double>(all.size());
      thickness += one[s].thickness / static_cast<double>(all.size());
    }
    SlabModuli& mean = out.emplace_back(slab_of_realizations(constants));
    if (all.size() == 1) mean.error = all.front()[s].error;
    mean.depth = depth;
    mean.thickness = thickness;
  }
  return out;
}

}  // namespace grainfield::coupling
