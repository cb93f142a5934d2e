// Goldhirsch 2010; Weinhart, Thornton, Luding, Bokhove 2012. With the kernel phi:
//   density = sum m phi(r - x_i)
//   sigma   = sum over contacts F (outer) l * integral_0^1 phi(r - x_i - t l) dt
// where F acts on grain i and l is the branch: x_j - x_i for a pair, contact point - x_i for a wall
// or a fixed grain. Because div of one branch's term is F (phi(r - start) - phi(r - end)), summing
// over a grain at rest leaves -(m g + applied force) phi(r - x_i), and every branch that ends on
// the apparatus leaves -F phi(r - end): the traction.
#include <cmath>

#include "coupling/averaging/kernel.h"
#include "coupling/averaging/weights.h"

namespace grainfield::coupling {
namespace {

using Eigen::Vector2d;

Vector2d plane(const dem::Vec3& v) { return v.head<2>(); }

void add_branch(const Kernel& kernel, const PointCells& cells, const Eigen::MatrixXd& points,
                const Vector2d& a, const Vector2d& b, const Vector2d& force, Sums& sums) {
  const Vector2d reach = Vector2d::Constant(kernel.range()), l = b - a;
  cells.near(a.cwiseMin(b) - reach, a.cwiseMax(b) + reach, [&](Eigen::Index p) {
    const double w = branch_weight(kernel, points.row(p).transpose(), a, b);
    if (w == 0) return;
    sums(p, kXX) += w * force.x() * l.x();
    sums(p, kYY) += w * force.y() * l.y();
    sums(p, kXY) += w * force.x() * l.y();
    sums(p, kYX) += w * force.y() * l.x();
  });
}

template <class Add>
void add_at(const Kernel& kernel, const PointCells& cells, const Eigen::MatrixXd& points,
            const Vector2d& at, Add&& add) {
  const Vector2d reach = Vector2d::Constant(kernel.range());
  cells.near(at - reach, at + reach, [&](Eigen::Index p) {
    const double r = (points.row(p).transpose() - at).norm();
    if (r < kernel.range()) add(p, kernel.value(r));
  });
}

}  // namespace

void add_coarse_graining(const dem::Snapshot& snapshot, const LayerFrame& frame,
                         const Eigen::MatrixXd& points, Eigen::Index first, Eigen::Index last,
                         const AverageOptions& options, Sums& sums) {
  const auto kernel = make_kernel(options.kernel, options.width);
  const PointCells cells(points, first, last, kernel->range());
  for (const dem::Grain& grain : snapshot.grains) {
    if (grain.fixed) continue;
    add_at(*kernel, cells, points, plane(grain.position),
           [&](Eigen::Index p, double weight) { add_grain(snapshot, grain, weight, p, sums); });
  }
  // Far enough that the end of an extended branch is out of reach of every point of the layer, also
  // where contacts with a rough floor lie above its mean height.
  const double beyond = 2 * kernel->range();
  const Vector2d gravity = plane(snapshot.gravity);
  const Vector2d down = gravity.norm() > 0 ? Vector2d(gravity.normalized()) : Vector2d(0, -1);
  for (const dem::Contact& contact : snapshot.contacts) {
    const dem::Grain& gi = snapshot.grains[static_cast<std::size_t>(contact.i)];
    const dem::Grain* gj =
        contact.j >= 0 ? &snapshot.grains[static_cast<std::size_t>(contact.j)] : nullptr;
    if (gi.fixed && (!gj || gj->fixed)) continue;
    if (gj && !gi.fixed && !gj->fixed) {
      add_branch(*kernel, cells, points, plane(gi.position), plane(gj->position),
                 plane(contact.force), sums);
      continue;
    }
    const dem::Grain& free = gi.fixed ? *gj : gi;
    const Vector2d force = gi.fixed ? Vector2d(-plane(contact.force)) : plane(contact.force);
    Vector2d end = plane(contact.point);
    add_branch(*kernel, cells, points, plane(free.position), end, force, sums);
    if (options.extend_into_walls) {
      Vector2d into = down;
      double length = beyond;
      if (!gj)
        into = -plane(snapshot.walls[static_cast<std::size_t>(-1 - contact.j)].normal);
      else
        length += std::max(0.0, end.y() - frame.floor);
      const Vector2d far = end + length * into;
      add_branch(*kernel, cells, points, end, far, force, sums);
      end = far;
    }
    add_at(*kernel, cells, points, end, [&](Eigen::Index p, double weight) {
      sums(p, kTractionX) += weight * force.x();
      sums(p, kTractionY) += weight * force.y();
    });
  }
}

}  // namespace grainfield::coupling
