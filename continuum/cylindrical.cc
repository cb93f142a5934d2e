#include "continuum/cylindrical.h"

#include <cmath>

namespace grainfield::continuum {

Stresses in_cylindrical_axes(const Points& points, const Stresses& stresses) {
  Stresses out(stresses.rows(), 6);
  for (Eigen::Index i = 0; i < stresses.rows(); ++i) {
    const double r = std::hypot(points(i, 0), points(i, 1));
    const double c = r > 0 ? points(i, 0) / r : 1, s = r > 0 ? points(i, 1) / r : 0;
    const double xx = stresses(i, 0), yy = stresses(i, 1), zz = stresses(i, 2), yz = stresses(i, 3),
                 xz = stresses(i, 4), xy = stresses(i, 5);
    out.row(i) << c * c * xx + s * s * yy + 2 * c * s * xy,
        s * s * xx + c * c * yy - 2 * c * s * xy, zz, c * yz - s * xz, c * xz + s * yz,
        c * s * (yy - xx) + (c * c - s * s) * xy;
  }
  return out;
}

}  // namespace grainfield::continuum
