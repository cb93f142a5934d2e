#include "coupling/structure/size_factor.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "coupling/averaging/grain_facts.h"

namespace grainfield::coupling {

SizeFactor size_factor(const dem::Snapshot& snapshot) {
  SizeFactor out;
  double volume = 0, contacts = 0, both = 0;
  std::vector<double> radii;
  for (const GrainFacts& facts : grain_facts(snapshot)) {
    const dem::Grain& grain = *facts.grain;
    if (grain.fixed) continue;
    ++out.grains;
    volume += grain.volume;
    contacts += facts.contacts;
    both += grain.volume * facts.contacts;
    radii.push_back(grain.outline.empty() ? grain.radius
                                          : std::sqrt(grain.volume / std::numbers::pi));
  }
  if (out.grains == 0) throw std::invalid_argument("the snapshot has no free grain");
  out.coordination = contacts / out.grains;
  out.measured = contacts > 0 ? out.grains * both / (volume * contacts)
                              : std::numeric_limits<double>::quiet_NaN();
  out.theory = size_factor_theory(
      Eigen::Map<const Eigen::VectorXd>(radii.data(), static_cast<Eigen::Index>(radii.size())),
      snapshot.dim);
  return out;
}

double size_factor_theory(const Eigen::VectorXd& radii, int dim) {
  const double mean = radii.mean();
  double volume = 0, inverse = 0, both = 0;
  for (const double radius : radii) {
    const double a = radius / mean, s = 1 / (1 + a);
    const double omega =
        dim == 2 ? 2 * std::asin(s) : 2 * std::numbers::pi * (1 - std::sqrt(1 - s * s));
    const double v = dim == 2 ? a * a : a * a * a;
    volume += v;
    inverse += 1 / omega;
    both += v / omega;
  }
  return both * static_cast<double>(radii.size()) / (volume * inverse);
}

}  // namespace grainfield::coupling
