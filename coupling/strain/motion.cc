#include "coupling/strain/motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "coupling/averaging/average.h"
#include "dem/snapshot/displacements.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {

namespace {

// From one orientation to the other, in space: the vector along the axis, rad. In the plane along
// z.
dem::Vec3 turn_between(const dem::Grain& before, const dem::Grain& after, int dim) {
  if (dim == 2) return {0, 0, std::remainder(after.angle - before.angle, 2 * std::numbers::pi)};
  const auto quaternion = [](const dem::Grain& g) {
    return Eigen::Quaterniond(g.orientation[0], g.orientation[1], g.orientation[2],
                              g.orientation[3])
        .normalized();
  };
  Eigen::Quaterniond turn = quaternion(after) * quaternion(before).conjugate();
  if (turn.w() < 0) turn.coeffs() *= -1;
  const double sine = turn.vec().norm();
  if (sine == 0) return dem::Vec3::Zero();
  return 2 * std::atan2(sine, turn.w()) / sine * turn.vec();
}

bool tells_orientation(const dem::Snapshot& s) {
  constexpr std::array<double, 4> none{1, 0, 0, 0};
  return std::any_of(s.grains.begin(), s.grains.end(),
                     [&](const dem::Grain& g) { return g.orientation != none; });
}

}  // namespace

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
  std::vector<dem::Vec3> turn(static_cast<std::size_t>(grains));
  motion.turns = dim == 2 || tells_orientation(before) || tells_orientation(after);
  const dem::Displacements displacements(before, after);
  motion.images = displacements.images();
  motion.doubt = displacements.doubt();
  for (std::size_t g = 0; g < before.grains.size(); ++g) {
    const Eigen::Index k = row[g];
    if (k < 0) continue;
    const dem::Grain &a = before.grains[g], &b = after.grains[g];
    motion.position.row(k) = a.position.head(dim).transpose();
    motion.displacement.row(k) = displacements.of(g).head(dim).transpose();
    motion.mass[k] = a.mass;
    turn[static_cast<std::size_t>(k)] = turn_between(a, b, before.dim);
  }

  motion.contact_point.resize(contacts, dim);
  motion.branch.resize(contacts, dim);
  motion.relative.resize(contacts, dim);
  motion.slip.resize(contacts, dim);
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
      motion.relative.row(c) += displacements.of_image(contact.image).head(dim).transpose();
    const dem::Vec3 &turn_p = turn[static_cast<std::size_t>(p)],
                    &turn_q = turn[static_cast<std::size_t>(q)];
    if (dim == 2) {  // dw x r = dw (-r_y, r_x)
      motion.slip.row(c) = motion.relative.row(c) +
                           turn_q.z() * Eigen::RowVector2d(-arm_q[1], arm_q[0]) -
                           turn_p.z() * Eigen::RowVector2d(-arm_p[1], arm_p[0]);
    } else {
      const dem::Vec3 of_p = arm_p.transpose(), of_q = arm_q.transpose();
      motion.slip.row(c) =
          motion.relative.row(c) + (turn_q.cross(of_q) - turn_p.cross(of_p)).transpose();
    }
    ++c;
  }
  return motion;
}

}  // namespace grainfield::coupling
