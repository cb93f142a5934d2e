#include "coupling/structure/grain_axes.h"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "coupling/averaging/grain_facts.h"
#include "coupling/structure/tensor_axes.h"

namespace grainfield::coupling {

GrainAxes grain_axes(const dem::Snapshot& snapshot) {
  if (snapshot.dim != 2)
    throw std::invalid_argument("orientation of grains: the snapshot is 3D; a 2D one is needed");
  std::vector<TensorAxes> tensors;
  for (const dem::Grain& grain : snapshot.grains)
    if (!grain.fixed) tensors.push_back(tensor_axes(inertia_of(grain, 2), 2));
  const auto n = static_cast<Eigen::Index>(tensors.size());
  GrainAxes out;
  out.inertia_angle_deg.resize(n);
  out.long_angle_deg.resize(n);
  out.elongation.resize(n);
  std::complex<double> sum = 0;
  int counted = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const TensorAxes& axes = tensors[static_cast<std::size_t>(k)];
    out.inertia_angle_deg[k] = axes.angle_deg(0);
    out.long_angle_deg[k] = axes.angle_deg(1);
    out.elongation[k] = std::sqrt(axes.values[0] / axes.values[1]);
    if (std::isnan(out.long_angle_deg[k])) continue;
    sum += std::polar(1.0, out.long_angle_deg[k] * std::numbers::pi / 90);
    ++counted;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  out.order = counted > 0 ? std::abs(sum) / counted : nan;
  out.director_deg = counted > 0 ? std::arg(sum) * 90 / std::numbers::pi : nan;
  return out;
}

}  // namespace grainfield::coupling
