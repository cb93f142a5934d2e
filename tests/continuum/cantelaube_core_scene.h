// Points and figures for the tests of Cantelaube's core.
#pragma once
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "continuum/model.h"

namespace grainfield::continuum::testing {

/// The linear solver's 1e-10 of the load; with a yielding axis its iteration's 1e-9, amplified.
inline constexpr double kExact = 1e-8, kExactYielding = 5e-7;

/// A grid over the heap's section of height h.
inline Points over_the_heap(double phi_deg, double h) {
  std::vector<std::pair<double, double>> inside;
  const double reach = h / std::tan(phi_deg * M_PI / 180);
  for (int j = 1; j <= 12; ++j)
    for (int i = -12; i <= 12; ++i)
      inside.emplace_back(0.99 * reach * j / 12 * i / 12, -h * j / 12);
  Points points(static_cast<Eigen::Index>(inside.size()), 2);
  for (Eigen::Index k = 0; k < points.rows(); ++k)
    points.row(k) << inside[static_cast<std::size_t>(k)].first,
        inside[static_cast<std::size_t>(k)].second;
  return points;
}

inline double figure(const std::unique_ptr<Model>& model, const std::string& name) {
  return model->figures().at(name);
}

}  // namespace grainfield::continuum::testing
