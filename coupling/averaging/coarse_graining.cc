// Goldhirsch 2010; Weinhart, Thornton, Luding, Bokhove 2012. With the kernel phi:
//   density = sum m phi(r - x_i)
//   sigma   = sum over contacts F (outer) l * integral_0^1 phi(r - x_i - t l) dt
// where F acts on grain i and l is the branch: x_j - x_i for a pair, contact point - x_i for a wall
// or a fixed grain. Because div of one branch's term is F (phi(r - start) - phi(r - end)), summing
// over a grain at rest leaves -(m g + applied force) phi(r - x_i), and every branch that ends on
// the apparatus leaves -F phi(r - end): the traction.
#include <cmath>

#include "coupling/averaging/branches.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/weights.h"

namespace grainfield::coupling {
namespace {

// Divides by the share of the kernel inside the packing: what grains carry by the share inside the
// whole region, the stress by that below the free surface where its branches go on into the walls.
template <int D>
void normalise(const Job& job, const Kernel& kernel, Eigen::Index first, Eigen::Index last,
               Sums& sums) {
  const int tensor = job.layout.dim() * job.layout.dim(), carried = job.layout.carried();
  for (Eigen::Index p = first; p < last; ++p) {
    const Eigen::Matrix<double, D, 1> at = job.points.row(p).transpose();
    const double inside = job.region.share(kernel, at, false);
    const double below =
        job.options.extend_into_walls ? job.region.share(kernel, at, true) : inside;
    sums.outside[static_cast<std::size_t>(p)] = inside < least_share || below < least_share;
    sums.rows.row(p).head(tensor) /= below;
    sums.rows.row(p).tail(sums.rows.cols() - carried) /= inside;
  }
}

template <int D>
void add(const Job& job, Eigen::Index first, Eigen::Index last, Sums& sums) {
  using Vector = Eigen::Matrix<double, D, 1>;
  const dem::Snapshot& snapshot = job.snapshot;
  const Eigen::MatrixXd& points = job.points;
  const auto kernel = make_kernel(job.options.kernel, job.options.width, D);
  const PointCells<D> cells(points, first, last, kernel->range());
  const Vector reach = Vector::Constant(kernel->range());
  const auto near_point = [&](const Vector& at, auto&& act) {
    cells.near(at - reach, at + reach, [&](Eigen::Index p) {
      const double r = (points.row(p).transpose() - at).norm();
      if (r < kernel->range()) act(p, kernel->value(r));
    });
  };
  const int count = job.layout.count(), carried = job.layout.carried();
  const Eigen::Index tail = job.layout.size() - carried;
  GrainLoad load(job);
  for (std::size_t g = 0; g < snapshot.grains.size(); ++g) {
    if (snapshot.grains[g].fixed) continue;
    load.take(g);
    near_point(snapshot.grains[g].position.head<D>(), [&](Eigen::Index p, double weight) {
      sums.rows(p, count) += 1;
      sums.rows.row(p).tail(tail) += weight * load.row().tail(tail);
    });
  }
  // Far enough that the end of an extended branch is out of reach of every point of the packing.
  const BranchEnds ends{job.options.extend_into_walls, job.region.floor(), 2 * kernel->range()};
  for_each_branch(
      snapshot, ends,
      [&](const dem::Vec3& from, const dem::Vec3& to, const dem::Vec3& force) {
        const Vector a = from.head<D>(), b = to.head<D>();
        const Eigen::Matrix<double, D, D, Eigen::RowMajor> stress =
            force.head<D>() * (b - a).transpose();
        cells.near(a.cwiseMin(b) - reach, a.cwiseMax(b) + reach, [&](Eigen::Index p) {
          const double w = branch_weight(*kernel, Vector(points.row(p).transpose()), a, b);
          if (w == 0) return;
          double* row = sums.rows.row(p).data();
          for (int k = 0; k < D * D; ++k) row[k] += w * stress.data()[k];
        });
      },
      [&](const dem::Vec3& at, const dem::Vec3& force) {
        near_point(at.head<D>(), [&](Eigen::Index p, double weight) {
          for (int a = 0; a < D; ++a) sums.rows(p, D * D + a) += weight * force[a];
        });
      });
  if (job.options.free_surface == "normalised") normalise<D>(job, *kernel, first, last, sums);
}

}  // namespace

void add_coarse_graining(const Job& job, Eigen::Index first, Eigen::Index last, Sums& sums) {
  if (job.layout.dim() == 2)
    add<2>(job, first, last, sums);
  else
    add<3>(job, first, last, sums);
}

}  // namespace grainfield::coupling
