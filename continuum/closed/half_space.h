// Point load on an elastic half plane (Flamant) and half space (Boussinesq): stress and
// displacement as plain functions. The load F acts at the origin, down; y (2D) or z (3D) is up, the
// material fills y < 0 or z < 0; tension positive. The scalar type may be complex, so that a test
// can differentiate them exactly by a complex step.
#pragma once
#include <array>
#include <cmath>

namespace grainfield::continuum {

/// Stress xx, yy, xy of Flamant's solution (Roul 5.2-5.4), N/m for F in N per unit thickness.
template <typename T>
std::array<T, 3> flamant_stress(double F, const T& x, const T& y) {
  const T depth = -y;
  const T r2 = x * x + depth * depth;
  const T scale = -2. * F / M_PI / (r2 * r2);
  // Compression along the ray from the load; sigma_xy changes sign with the axis that points up.
  return {scale * depth * x * x, scale * depth * depth * depth, -scale * depth * depth * x};
}

/// Displacement x, y of Flamant's solution in plane strain, E and nu of the three-dimensional
/// material. The field grows with the logarithm of distance; its free rigid part is chosen so that
/// the point at unit distance below the load stays at rest (Johnson, Contact Mechanics, 2.19).
inline std::array<double, 2> flamant_displacement(double F, double E, double nu, double x,
                                                  double y) {
  const double depth = -y;
  const double r2 = x * x + depth * depth;
  const double scale = F * (1 + nu) / (M_PI * E);
  const double down = -scale * ((1 - nu) * std::log(r2) + x * x / r2);
  return {scale * (x * depth / r2 - (1 - 2 * nu) * std::atan2(x, depth)), -down};
}

/// Stress xx, yy, zz, yz, xz, xy of Boussinesq's solution in Cartesian axes, Pa (Love's form, whose
/// denominators do not vanish on the axis below the load).
template <typename T>
std::array<T, 6> boussinesq_stress(double F, double nu, const T& x, const T& y, const T& z) {
  using std::sqrt;
  const T depth = -z;
  const T r2 = x * x + y * y + depth * depth;
  const T r = sqrt(r2);
  const T r3 = r2 * r, r5 = r3 * r2, sum = r + depth;
  const double scale = F / (2 * M_PI);
  const double compressible = 1 - 2 * nu;
  const T even = depth / r3 - 1. / (r * sum);
  const T odd = (2. * r + depth) / (r3 * sum * sum);
  return {scale * (-3. * x * x * depth / r5 + compressible * (even + x * x * odd)),
          scale * (-3. * y * y * depth / r5 + compressible * (even + y * y * odd)),
          scale * (-3. * depth * depth * depth / r5),
          scale * (3. * y * depth * depth / r5),
          scale * (3. * x * depth * depth / r5),
          scale * x * y * (-3. * depth / r5 + compressible * odd)};
}

/// Displacement x, y, z of Boussinesq's solution, which vanishes far away (Johnson 3.18).
inline std::array<double, 3> boussinesq_displacement(double F, double E, double nu, double x,
                                                     double y, double z) {
  const double depth = -z;
  const double r2 = x * x + y * y + depth * depth;
  const double r = std::sqrt(r2);
  const double scale = F * (1 + nu) / (2 * M_PI * E);
  const double side = depth / (r2 * r) - (1 - 2 * nu) / (r * (r + depth));
  return {scale * x * side, scale * y * side,
          -scale * (depth * depth / (r2 * r) + 2 * (1 - nu) / r)};
}

}  // namespace grainfield::continuum
