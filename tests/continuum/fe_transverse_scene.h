// Finite elements of a transversely isotropic body in space beside its closed form: the largest
// error of all components at each depth over that depth's largest component.
#pragma once
#include <algorithm>
#include <cstdio>
#include <string>

#include "continuum/model.h"

namespace grainfield::continuum {

/// Stiffer across than along the axis, the reverse, and one of which c13 is negative.
struct TransverseCase {
  const char* name;
  Settings moduli;
};
inline const TransverseCase kTransverseCases[] = {
    {"stiff across",
     {{"E_h", "2"}, {"E_v", "1"}, {"nu_h", "0.2"}, {"nu_v", "0.15"}, {"G_v", "0.4"}}},
    {"stiff along",
     {{"E_h", "1"}, {"E_v", "2"}, {"nu_h", "0.3"}, {"nu_v", "0.25"}, {"G_v", "0.6"}}},
    {"widening",
     {{"E_h", "1"}, {"E_v", "1.2"}, {"nu_h", "0.1"}, {"nu_v", "-0.2"}, {"G_v", "0.5"}}}};

/// Points at a depth, on the axis, along x and beside the axes, up to `reach` depths out.
inline Points transverse_points(double depth, double reach) {
  Points points(7, 3);
  int row = 0;
  for (const double r : {0., 0.25, 0.5, 1.}) points.row(row++) << r * reach * depth, 0, -depth;
  for (const double r : {0.3, 0.6, 1.})
    points.row(row++) << -0.6 * r * reach * depth, 0.8 * r * reach * depth, -depth;
  return points;
}

inline double transverse_error(Model& elements, Model& closed, double depth, double reach) {
  const Points points = transverse_points(depth, reach);
  const Stresses exact = closed.stress(points), found = elements.stress(points);
  const double error = (found - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
  std::printf("depth %.3g: %.2e of the largest component\n", depth, error);
  return error;
}

}  // namespace grainfield::continuum
