// Over representative volume elements (RVE), Roul ch. 2.6: with a weight w of every grain,
//   <q> = (1/V) sum w q_p,  stress: q_p = sum over its contacts of F (outer) x,
// x from centroid to contact. V is the part of the RVE inside the packing (region.h).
//   particle_centre: w = 1 for grains with centroid in the RVE
//   area_exact:      w = share of the grain's area (in 3D of the sphere's volume) inside the RVE
#include <limits>

#include "coupling/averaging/clip.h"
#include "coupling/averaging/extent.h"
#include "coupling/averaging/weights.h"

namespace grainfield::coupling {
namespace {

struct Rve {
  const Support& support;
  Eigen::VectorXd volume;
};

Rve measure(const Job& job, Eigen::Index first, Eigen::Index last, Sums& sums) {
  const Support& support = *find_support(job.options.kernel);
  Rve rve{support, Eigen::VectorXd::Zero(job.points.rows())};
  const double whole = support.measure(job.options.width, job.layout.dim());
  for (Eigen::Index p = first; p < last; ++p) {
    rve.volume[p] = job.region.measure(support, job.options.width, job.points.row(p).transpose());
    sums.outside[static_cast<std::size_t>(p)] = rve.volume[p] < least_share * whole;
  }
  return rve;
}

void add_grain(const Job& job, GrainLoad& load, double share, double volume, Eigen::Index p,
               Sums& sums) {
  const int dim = job.layout.dim(), count = job.layout.count(), carried = job.layout.carried();
  const Eigen::RowVectorXd& row = load.row();
  const double weight = share / volume;
  sums.rows(p, count) += share;
  sums.rows.row(p).head(dim * dim) += weight * row.head(dim * dim);
  const Eigen::Index tail = sums.rows.cols() - carried;
  sums.rows.row(p).tail(tail) += weight * row.tail(tail);
}

template <int D>
void add(const Job& job, Eigen::Index first, Eigen::Index last, Sums& sums) {
  using Vector = Eigen::Matrix<double, D, 1>;
  const Rve rve = measure(job, first, last, sums);
  const double width = job.options.width;
  const PointCells<D> cells(job.points, first, last, width);
  GrainLoad load(job);
  for (std::size_t g = 0; g < job.snapshot.grains.size(); ++g) {
    const dem::Grain& grain = job.snapshot.grains[g];
    if (grain.fixed) continue;
    load.take(g);
    const Vector at = grain.position.head<D>(), reach = Vector::Constant(width);
    cells.near(at - reach, at + reach, [&](Eigen::Index p) {
      Eigen::Vector3d d = Eigen::Vector3d::Zero();
      d.head<D>() = at - job.points.row(p).transpose();
      if (rve.volume[p] > 0 && rve.support.distance(d) < width)
        add_grain(job, load, 1, rve.volume[p], p, sums);
    });
  }
}

}  // namespace

const std::vector<std::string>& support_names() {
  static const std::vector<std::string> names{"circle", "square"};
  return names;
}

void add_particle_centre(const Job& job, Eigen::Index first, Eigen::Index last, Sums& sums) {
  if (job.layout.dim() == 2)
    add<2>(job, first, last, sums);
  else
    add<3>(job, first, last, sums);
}

namespace {

void add_volume_exact(const Job& job, Eigen::Index first, Eigen::Index last, Sums& sums) {
  using Eigen::Vector3d;
  const Rve rve = measure(job, first, last, sums);
  const double width = job.options.width;
  const PointCells<3> cells(job.points, first, last, width);
  GrainLoad load(job);
  for (std::size_t g = 0; g < job.snapshot.grains.size(); ++g) {
    const dem::Grain& grain = job.snapshot.grains[g];
    if (grain.fixed) continue;
    load.take(g);
    const Vector3d at = grain.position, reach = Vector3d::Constant(width + grain.radius);
    const double whole = rve.support.of_ball(2 * grain.radius, Vector3d::Zero(), grain.radius);
    cells.near(at - reach, at + reach, [&](Eigen::Index p) {
      const Vector3d d = at - job.points.row(p).transpose();
      const double inner = rve.support.distance(d);
      if (rve.volume[p] <= 0 || inner - grain.radius >= width) return;
      const double share =
          inner + grain.radius > width ? rve.support.of_ball(width, d, grain.radius) / whole : 1;
      if (share > 0) add_grain(job, load, share, rve.volume[p], p, sums);
    });
  }
}

}  // namespace

void add_area_exact(const Job& job, Eigen::Index first, Eigen::Index last, Sums& sums) {
  using Eigen::Vector2d;
  if (job.layout.dim() == 3) return add_volume_exact(job, first, last, sums);
  const Rve rve = measure(job, first, last, sums);
  const double width = job.options.width;
  const PointCells<2> cells(job.points, first, last, width);
  Corners placed, shifted;
  GrainLoad load(job);
  for (std::size_t g = 0; g < job.snapshot.grains.size(); ++g) {
    const dem::Grain& grain = job.snapshot.grains[g];
    if (grain.fixed) continue;
    load.take(g);
    placed = placed_outline(grain);
    const double area =
        placed.empty() ? disk_in_disk(0, grain.radius, grain.radius) : area_of(placed);
    const Vector2d at = grain.position.head<2>();
    const Vector2d reach = Vector2d::Constant(width + grain.radius);
    cells.near(at - reach, at + reach, [&](Eigen::Index p) {
      if (rve.volume[p] <= 0) return;
      const Vector2d point = job.points.row(p).transpose(), d = at - point;
      // Wholly inside or outside by its circumscribed circle: nothing to clip.
      const double inner = rve.support.distance({d.x(), d.y(), 0});
      double share = 1;
      if (inner - grain.radius >= width) return;
      if (inner + grain.radius > width) {
        if (placed.empty()) {
          share = rve.support.of_disk(width, d, grain.radius) / area;
        } else {
          shifted = placed;
          for (Vector2d& corner : shifted) corner -= point;
          share = rve.support.in_polygon(width, shifted) / area;
        }
      }
      if (share > 0) add_grain(job, load, share, rve.volume[p], p, sums);
    });
  }
}

}  // namespace grainfield::coupling
