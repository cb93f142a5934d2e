#include "coupling/strain/motion.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "coupling/averaging/average.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {

GrainMotion grain_motion(const dem::Snapshot& before, const dem::Snapshot& after) {
  require_same_grains(before, after);
  GrainMotion motion;
  motion.dim = before.dim;
  const Eigen::Index dim = before.dim;
  std::vector<Eigen::Index> row(before.grains.size(), -1);
  Eigen::Index grains = 0, contacts = 0;
  for (std::size_t g = 0; g < before.grains.size(); ++g)
    if (!before.grains[g].fixed) row[g] = grains++;
  const auto row_of = [&](std::int64_t grain) {
    return grain < 0 ? -1 : row[static_cast<std::size_t>(grain)];
  };
  for (const dem::Contact& contact : before.contacts)
    contacts += row_of(contact.i) >= 0 && row_of(contact.j) >= 0;

  motion.position.resize(grains, dim);
  motion.displacement.resize(grains, dim);
  motion.mass.resize(grains);
  Eigen::VectorXd turn(grains);
  const bool counted = dem::counts_images(before) || dem::counts_images(after);
  for (std::size_t g = 0; g < before.grains.size(); ++g) {
    const Eigen::Index k = row[g];
    if (k < 0) continue;
    const dem::Grain &a = before.grains[g], &b = after.grains[g];
    motion.position.row(k) = a.position.head(dim).transpose();
    motion.displacement.row(k) =
        dem::displacement(a, b, before.cell, after.cell, counted).head(dim).transpose();
    motion.mass[k] = a.mass;
    turn[k] = std::remainder(b.angle - a.angle, 2 * std::numbers::pi);
  }

  motion.contact_point.resize(contacts, dim);
  motion.branch.resize(contacts, dim);
  motion.relative.resize(contacts, dim);
  if (dim == 2) motion.slip.resize(contacts, dim);
  Eigen::Index c = 0;
  for (const dem::Contact& contact : before.contacts) {
    const Eigen::Index p = row_of(contact.i), q = row_of(contact.j);
    if (p < 0 || q < 0) continue;
    const Eigen::RowVectorXd point = contact.point.head(dim).transpose();
    const Eigen::RowVectorXd second = dem::second_place(before, contact).head(dim).transpose();
    const Eigen::RowVectorXd arm_p = point - motion.position.row(p), arm_q = point - second;
    motion.contact_point.row(c) = point;
    motion.branch.row(c) = second - motion.position.row(p);
    motion.relative.row(c) = motion.displacement.row(q) - motion.displacement.row(p);
    if (before.cell.is_periodic())  // the image moves with the cell's edges
      motion.relative.row(c) +=
          (dem::shift_to(after.cell, dem::image_in(after.cell, before.cell, contact.image)) -
           dem::shift_to(before.cell, contact.image))
              .head(dim)
              .transpose();
    if (dim == 2)  // dw x r = dw (-r_y, r_x)
      motion.slip.row(c) = motion.relative.row(c) +
                           turn[q] * Eigen::RowVector2d(-arm_q[1], arm_q[0]) -
                           turn[p] * Eigen::RowVector2d(-arm_p[1], arm_p[0]);
    ++c;
  }
  return motion;
}

}  // namespace grainfield::coupling
