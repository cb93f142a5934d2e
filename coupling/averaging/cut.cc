// Vertical force through horizontal cuts.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/branches.h"
#include "coupling/averaging/clip.h"
#include "coupling/averaging/extent.h"
#include "coupling/averaging/kernel.h"
#include "coupling/averaging/periodic.h"
#include "coupling/averaging/weights.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;

// Index of a cell among n that repeat, or the nearest of them.
Index cell_index(double k, Index n, bool repeats) {
  const auto count = static_cast<double>(n);
  if (repeats) k -= count * std::floor(k / count);
  return static_cast<Index>(std::clamp(k, 0.0, count - 1));
}

// Share of a sphere above z: a cap, 2 (1 - c)^2 (2 + c) / 8 with c = height over the radius.
double share_of_sphere_above(const dem::Grain& grain, double z) {
  const double c = std::clamp((z - grain.position.z()) / grain.radius, -1.0, 1.0);
  return (1 - c) * (1 - c) * (2 + c) / 4;
}

// Share of the grain's area above y.
double share_above(const dem::Grain& grain, double y) {
  if (bottom_of(grain) >= y) return 1;
  if (top_of(grain) <= y) return 0;
  if (grain.outline.empty())
    return disk_above(grain.radius, y - grain.position.y()) /
           disk_above(grain.radius, -grain.radius);
  const Corners corners = placed_outline(grain);
  const double reach = grain.radius + std::abs(y - grain.position.y());
  const Vector2d at = grain.position.head<2>();
  return area_in_box(corners, {at.x() - reach, y}, at + Vector2d::Constant(reach)) /
         area_of(corners);
}

// Weight above, `share(height)` of a force at a height and `of_grain(grain)` of a grain's own.
template <class OfGrain, class Share>
double weight(const dem::Snapshot& snapshot, const BranchEnds& ends, OfGrain&& of_grain,
              Share&& share) {
  const int up = up_axis(snapshot.dim);
  double sum = 0;
  for (const dem::Grain& grain : snapshot.grains) {
    if (grain.fixed) continue;
    sum -= grain.mass * snapshot.gravity[up] * of_grain(grain);
    if (dem::is_loaded(snapshot, grain.id))
      sum -= snapshot.applied_force[up] * share(grain.position[up]);
  }
  for_each_branch(
      snapshot, ends, [](const dem::Vec3&, const dem::Vec3&, const dem::Vec3&) {},
      [&](const dem::Vec3& at, const dem::Vec3& force) { sum -= force[up] * share(at[up]); });
  return sum;
}

// The vertical force through every cell of `cut` (columns, spacing dx) at the heights (rows, from
// `bottom` on, spacing dy), N: of the contacts whose branch crosses that height, where it does;
// what weight_above has beyond them (parts of grains on the other side of the line than their
// centroid) is spread over the width as the height of the packing above.
RowMatrix force_through(const dem::Snapshot& snapshot, const Region& region, const MatrixXd& cut,
                        double dx, const Eigen::VectorXd& heights) {
  const bool repeats = snapshot.cell.periodic[0];
  const Index rows = heights.size(), cells = cut.rows();
  RowMatrix force = RowMatrix::Zero(rows, cells);
  const double dy = rows > 1 ? heights[1] - heights[0] : 1;
  const auto cross = [&](const dem::Vec3& a, const dem::Vec3& b, const dem::Vec3& f) {
    const double low = std::min(a.y(), b.y()), high = std::max(a.y(), b.y());
    const auto row_from = [&](double y) {
      return static_cast<Index>(
          std::clamp(std::ceil((y - heights[0]) / dy), 0.0, static_cast<double>(rows)));
    };
    for (Index r = row_from(low); r < row_from(high); ++r) {
      const double x = a.x() + (heights[r] - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      const double k = std::floor((x - cut(0, 0)) / dx + 0.5);
      force(r, cell_index(k, cells, repeats)) += a.y() > b.y() ? f.y() : -f.y();
    }
  };
  for_each_branch(snapshot, {true, region.floor(), 0}, cross,
                  [](const dem::Vec3&, const dem::Vec3&) {});
  for (Index r = 0; r < rows; ++r) {
    Eigen::VectorXd above(cells);
    for (Index p = 0; p < cells; ++p)
      above[p] = std::max(0.0, region.surface(cut(p, 0)) - heights[r]);
    if (above.sum() <= 0) continue;
    const double rest = weight_above(snapshot, heights[r]) - force.row(r).sum();
    force.row(r) += rest / above.sum() * above.transpose();
  }
  return force;
}

// The vertical force averaged over the part of the RVE inside the packing and integrated along the
// cut, over the points where `known`. Midpoint rule on cells of `step`.
double weight_through_rve(const dem::Snapshot& snapshot, const Region& region, double y,
                          const AverageOptions& options, const MatrixXd& cut, double step,
                          const std::vector<bool>& known) {
  const Support& support = *find_support(options.kernel);
  const double width = options.width, bottom = std::max(region.floor(), y - width);
  const double top = std::min(region.highest(), y + width);
  if (!(top > bottom)) return 0;
  const Index rows = std::max<Index>(1, static_cast<Index>(std::ceil((top - bottom) / step)));
  const double dy = (top - bottom) / static_cast<double>(rows),
               dx = cut.rows() > 1 ? cut(1, 0) - cut(0, 0) : step;
  Eigen::VectorXd heights(rows);
  for (Index r = 0; r < rows; ++r) heights[r] = bottom + (static_cast<double>(r) + 0.5) * dy;
  const RowMatrix force = force_through(snapshot, region, cut, dx, heights);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(cut.rows());
  for (Index r = 0; r < rows; ++r) {
    // A chord of the RVE at this height takes a run of cells; running sums make it quick.
    Eigen::VectorXd running(cut.rows() + 1);
    running[0] = 0;
    for (Index p = 0; p < cut.rows(); ++p) running[p + 1] = running[p] + force(r, p) * dy;
    double half = width;
    if (support.distance({width, width, 0}) > width)
      half = std::sqrt(std::max(0.0, width * width - (heights[r] - y) * (heights[r] - y)));
    const auto n = static_cast<double>(cut.rows());
    const auto until = [&](double x) {  // of the force left of x, of a period after the other
      double k = (x - cut(0, 0)) / dx + 0.5, periods = 0;
      if (snapshot.cell.periodic[0]) periods = std::floor(k / n);
      k = std::clamp(k - periods * n, 0.0, n);
      const auto whole = std::min(static_cast<Index>(k), cut.rows() - 1);
      return periods * running[cut.rows()] + running[whole] +
             (k - static_cast<double>(whole)) * force(r, whole) * dy;
    };
    for (Index p = 0; p < cut.rows(); ++p)
      sum[p] += until(cut(p, 0) + half) - until(cut(p, 0) - half);
  }
  double total = 0;
  for (Index p = 0; p < cut.rows(); ++p)
    if (known[static_cast<std::size_t>(p)])
      total += sum[p] / region.measure(support, width, cut.row(p).transpose()) * dx;
  return total;
}

// What an averaging counts as inside its RVEs, over what is inside, along a cut.
double counted_share(const dem::Snapshot& snapshot, const MatrixXd& cut, AverageOptions options) {
  if (options.method == "area_exact") return 1;
  options.quantities = {"volume_fraction"};
  const auto solid = [&](const char* method) {
    options.method = method;
    const Eigen::VectorXd share = average(snapshot, cut, options).find("volume_fraction")->value;
    return share.array().isNaN().select(0, share).sum();
  };
  const double inside = solid("area_exact");
  return inside > 0 ? solid("particle_centre") / inside : 1;
}

// Midpoints of cells of the horizontal cut: as far out as branches into walls go, and along an axis
// that repeats exactly one period.
struct Cut {
  MatrixXd points;
  double cell = 0;                       // m, in space m2
  Index columns = 0, rows = 0;           // in space: x fastest
  double column_size = 0, row_size = 0;  // m
};

Cut cut_through(const dem::Snapshot& snapshot, const Region& region, double height, double range,
                double step) {
  struct Side {
    double first, last;
    int n;
    double size;
  };
  const dem::Cell<3>& cell = snapshot.cell;
  const auto ends = [&](int axis) {
    if (cell.periodic[axis])
      return std::pair{cell.low[axis], cell.low[axis] + cell.edges(axis, axis)};
    const double low = axis == 0 ? region.left() : region.front();
    const double high = axis == 0 ? region.right() : region.back();
    return std::pair{low - 4 * range, high + 4 * range};
  };
  const auto side = [&](int axis) {
    const auto [from, to] = ends(axis);
    const int n = std::max(1, static_cast<int>(std::ceil((to - from) / step)));
    const double size = (to - from) / n;
    return Side{from + size / 2, to - size / 2, n, size};
  };
  if (region.dim() == 2) {
    const Side x = side(0);
    return {line_points(x.first, x.last, x.n, height), x.size};
  }
  constexpr double most = 4e5;
  const auto [left, right] = ends(0);
  const auto [front, back] = ends(1);
  step = std::max(step, std::sqrt((right - left) * (back - front) / most));
  const Side x = side(0), y = side(1);
  return {cut_points({x.first, y.first}, {x.last, y.last}, x.n, y.n, {height}),
          x.size * y.size,
          x.n,
          y.n,
          x.size,
          y.size};
}

// In space, as weight_through_rve: of the vertical force at every height within reach what the
// elements of the cut see, each over its part inside the packing. A contact's force is where its
// branch crosses the height; what weight_above has beyond them is spread as the packing above.
class ElementsOfCut {
 public:
  ElementsOfCut(const dem::Snapshot& snapshot, const Region& region, const AverageOptions& options,
                const Cut& cut, const std::vector<bool>& known)
      : support_(*find_support(options.kernel)),
        width_(options.width),
        cut_(cut),
        repeats_{snapshot.cell.periodic[0], snapshot.cell.periodic[1]},
        inverse_(Eigen::VectorXd::Zero(cut.points.rows())) {
    for (Index p = 0; p < cut.points.rows(); ++p)
      if (known[static_cast<std::size_t>(p)])
        inverse_[p] = cut.cell / region.measure(support_, width_, cut.points.row(p).transpose());
  }

  // Integral over the elements' middles of 1 / V, of those that hold this place.
  double seen(const Eigen::Vector3d& at) const {
    const auto range = [&](int axis, double size, Index n) {
      const double middle = (at[axis] - cut_.points(0, axis)) / size, half = width_ / size;
      double first = std::ceil(middle - half), last = std::floor(middle + half);
      if (!repeats_[axis]) {
        const auto most = static_cast<double>(n - 1);
        first = std::clamp(first, 0.0, most);
        last = std::clamp(last, 0.0, most);
      }
      return std::pair{static_cast<Index>(first), static_cast<Index>(last)};
    };
    const auto [x0, x1] = range(0, cut_.column_size, cut_.columns);
    const auto [y0, y1] = range(1, cut_.row_size, cut_.rows);
    double sum = 0;
    for (Index y = y0; y <= y1; ++y)
      for (Index x = x0; x <= x1; ++x) {
        const Eigen::Vector3d middle(cut_.points(0, 0) + static_cast<double>(x) * cut_.column_size,
                                     cut_.points(0, 1) + static_cast<double>(y) * cut_.row_size,
                                     cut_.points(0, 2));
        if (!(support_.distance(at - middle) < width_)) continue;
        sum += inverse_[within(x, cut_.columns) + cut_.columns * within(y, cut_.rows)];
      }
    return sum;
  }

  double weight(const dem::Snapshot& snapshot, const Region& region, double z) const {
    const double bottom = std::max(region.floor(), z - width_),
                 top = std::min(region.highest(), z + width_);
    if (!(top > bottom)) return 0;
    constexpr Index slices = 24;
    const double dz = (top - bottom) / slices, first = bottom + dz / 2;
    Eigen::VectorXd crossing = Eigen::VectorXd::Zero(slices);
    double total = 0;
    const auto cross = [&](const dem::Vec3& a, const dem::Vec3& b, const dem::Vec3& f) {
      const auto from = [&](double height) {
        return static_cast<Index>(
            std::clamp(std::ceil((height - first) / dz), 0.0, static_cast<double>(slices)));
      };
      const double down = a.z() > b.z() ? f.z() : -f.z();
      for (Index k = from(std::min(a.z(), b.z())); k < from(std::max(a.z(), b.z())); ++k) {
        const double height = first + static_cast<double>(k) * dz;
        crossing[k] += down;
        total += dz * down * seen(a + (height - a.z()) / (b.z() - a.z()) * (b - a));
      }
    };
    for_each_branch(snapshot, {true, region.floor(), 0}, cross,
                    [](const dem::Vec3&, const dem::Vec3&) {});
    for (Index k = 0; k < slices; ++k) {
      const double height = first + static_cast<double>(k) * dz;
      double above = 0, seen_above = 0;
      for (Index p = 0; p < cut_.points.rows(); ++p) {
        const double x = cut_.points(p, 0), y = cut_.points(p, 1);
        const double rest = std::max(0.0, region.surface(x, y) - height);
        above += rest;
        if (rest > 0) seen_above += rest * seen({x, y, height});
      }
      if (above > 0)
        total += dz * (weight_above(snapshot, height) - crossing[k]) * seen_above / above;
    }
    return total;
  }

 private:
  // Cells beyond the cut are those of the next period; only asked for where that axis repeats.
  static Index within(Index k, Index n) { return (k % n + n) % n; }

  const Support& support_;
  double width_;
  const Cut& cut_;
  std::array<bool, 2> repeats_;
  Eigen::VectorXd inverse_;
};

}  // namespace

double weight_above(const dem::Snapshot& snapshot, double y) {
  // Fixed grains carry their force down to the floor's mean height.
  return weight(
      snapshot, {true, Region(snapshot).floor(), 0},
      [&](const dem::Grain& grain) {
        return snapshot.dim == 2 ? share_above(grain, y) : share_of_sphere_above(grain, y);
      },
      [&](double height) { return height > y ? 1.0 : 0.0; });
}

CutForce cut_force(const dem::Snapshot& snapshot, double y, const AverageOptions& given,
                   double step) {
  const int dim = snapshot.dim, up = up_axis(dim);
  AverageOptions options = given;
  options.quantities = {"sigma", "kinetic"};
  options.least_grains = 0;
  const bool kernels = options.method == "coarse_graining";
  const Region bare(snapshot);
  // Inclined walls carry their branches on beyond the packing: the line goes as far.
  const double range = kernels ? make_kernel(options.kernel, options.width, dim)->range() : 0;
  if (step <= 0) step = dim == 2 ? options.width / 40 : kernels ? range / 9 : options.width / 6;
  const Cut places = cut_through(snapshot, bare, y, range, step);
  const MatrixXd& line = places.points;
  const Field field = average(snapshot, line, options);
  const std::string vertical = dim == 2 ? "_yy" : "_zz";
  const Eigen::VectorXd stress =
      field.find("sigma" + vertical)->value + field.find("kinetic" + vertical)->value;
  CutForce cut;
  cut.height = y;
  cut.sharp = weight_above(snapshot, y);
  std::vector<bool> known;
  for (Index p = 0; p < line.rows(); ++p) {
    known.push_back(!std::isnan(stress[p]));
    if (known.back()) cut.force -= stress[p] * places.cell;
  }
  if (kernels) {
    const auto kernel = make_kernel(options.kernel, options.width, dim);
    const auto share = [&](double height) { return kernel->beyond(y - height); };
    cut.weight = weight(
        snapshot, {options.extend_into_walls, bare.floor(), 2 * range},
        [&](const dem::Grain& grain) { return share(grain.position[up]); }, share);
  } else {
    // What the elements hold of a packing that repeats is inside its images, too.
    const bool repeats = snapshot.cell.is_periodic();
    const Region region(repeats ? surround(snapshot, line, options.width).snapshot : snapshot);
    const double counted = counted_share(snapshot, line, options);
    cut.weight =
        counted *
        (dim == 2
             ? weight_through_rve(snapshot, region, y, options, line, places.cell, known)
             : ElementsOfCut(snapshot, region, options, places, known).weight(snapshot, region, y));
  }
  return cut;
}

}  // namespace grainfield::coupling
