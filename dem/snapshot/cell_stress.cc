#include "dem/snapshot/cell_stress.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

namespace grainfield::dem {

double cell_volume(const Cell<3>& cell, int dim) {
  for (int a = 0; a < dim; ++a) {
    if (cell.periodic[a]) continue;
    throw std::invalid_argument(
        fmt::format("the stress of a cell: found a cell that is not periodic along axis {}, "
                    "allowed: periodic along all {}",
                    "xyz"[a], dim));
  }
  if (dim == 2) return std::fabs(cell.edges.topLeftCorner<2, 2>().determinant());
  return std::fabs(cell.edges.determinant());
}

CellStress cell_stress(const Snapshot& snapshot) {
  const Cell<3>& cell = snapshot.cell;
  const double volume = cell_volume(cell, snapshot.dim);
  CellStress s{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  for (const Contact& c : snapshot.contacts) {
    if (c.j < 0) continue;
    const Vec3 image(c.image[0], c.image[1], c.image[2]);
    const Vec3 branch =
        snapshot.grains[c.j].position + cell.edges * image - snapshot.grains[c.i].position;
    s.contacts += c.force * branch.transpose() / volume;
  }
  for (const Grain& g : snapshot.grains) {
    const Vec3 u = g.velocity - cell.velocity_gradient * (g.position - cell.low);
    s.motion -= g.mass / volume * u * u.transpose();
  }
  return s;
}

}  // namespace grainfield::dem
