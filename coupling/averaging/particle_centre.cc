// sigma = (1/V) sum over grains with centroid in the support, over their contacts, of F (outer) x,
// x from centroid to contact (Roul ch. 2.6). V is the part of the support inside the layer: between
// the side walls, above the floor and below the mean surface.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "coupling/averaging/weights.h"

namespace grainfield::coupling {
namespace {

using Eigen::Vector2d;

// A support cut by the layer to less than this share is not averaged over: its few grains stand for
// an area that their own size exceeds.
constexpr double least_share = 0.1;

struct Support {
  bool (*holds)(const Vector2d& from_centre, double width);
  double (*area)(double width);
  /// Area of the support, centred at the origin, inside the rectangle.
  double (*cut)(double width, const Vector2d& low, const Vector2d& high);
};

// Area of the disk of radius r in the quadrant x < a, y < b: integrates the part of each vertical
// chord below b. With clipped a, b in [-r, r].
double disk_quadrant(double r, double a, double b) {
  a = std::clamp(a, -r, r);
  b = std::clamp(b, -r, r);
  // G(x) = integral of sqrt(r^2 - x^2) from -r to x.
  const auto half = [r](double x) {
    return 0.5 * (x * std::sqrt(std::max(0.0, r * r - x * x)) + r * r * std::asin(x / r)) +
           std::numbers::pi * r * r / 4;
  };
  const double c = std::sqrt(std::max(0.0, r * r - b * b));
  const double in = std::clamp(a, -c, c);
  // Inside |x| < c the chord runs from -sqrt to b; outside it is whole (b > 0) or empty (b < 0).
  double area = b * (in + c) + half(in) - half(-c);
  if (b > 0) area += 2 * half(std::min(a, -c)) + 2 * (half(std::max(a, c)) - half(c));
  return area;
}

double disk_cut(double r, const Vector2d& low, const Vector2d& high) {
  return disk_quadrant(r, high.x(), high.y()) - disk_quadrant(r, low.x(), high.y()) -
         disk_quadrant(r, high.x(), low.y()) + disk_quadrant(r, low.x(), low.y());
}

double square_cut(double w, const Vector2d& low, const Vector2d& high) {
  const double x = std::min(w, high.x()) - std::max(-w, low.x());
  const double y = std::min(w, high.y()) - std::max(-w, low.y());
  return std::max(0.0, x) * std::max(0.0, y);
}

const Support circle{[](const Vector2d& d, double w) { return d.squaredNorm() < w * w; },
                     [](double w) { return std::numbers::pi * w * w; }, disk_cut};
const Support square{[](const Vector2d& d, double w) { return d.cwiseAbs().maxCoeff() < w; },
                     [](double w) { return 4 * w * w; }, square_cut};

// Stress times volume of every grain: rows xx, yy, xy, yx.
Eigen::MatrixX4d grain_stresses(const dem::Snapshot& snapshot) {
  Eigen::MatrixX4d stress =
      Eigen::MatrixX4d::Zero(static_cast<Eigen::Index>(snapshot.grains.size()), 4);
  const auto add = [&](std::int64_t grain, const dem::Vec3& point, const dem::Vec3& f) {
    const dem::Vec3 x = point - snapshot.grains[static_cast<std::size_t>(grain)].position;
    stress.row(grain) +=
        Eigen::RowVector4d(f.x() * x.x(), f.y() * x.y(), f.x() * x.y(), f.y() * x.x());
  };
  for (const dem::Contact& contact : snapshot.contacts) {
    add(contact.i, contact.point, contact.force);
    if (contact.j >= 0) add(contact.j, contact.point, -contact.force);
  }
  return stress;
}

}  // namespace

const std::vector<std::string>& support_names() {
  static const std::vector<std::string> names{"circle", "square"};
  return names;
}

void add_particle_centre(const dem::Snapshot& snapshot, const LayerFrame& frame,
                         const Eigen::MatrixXd& points, Eigen::Index first, Eigen::Index last,
                         const AverageOptions& options, Sums& sums) {
  const Support& support = options.kernel == "square" ? square : circle;
  const double width = options.width;
  Eigen::VectorXd volume(points.rows());
  for (Eigen::Index p = first; p < last; ++p) {
    const Vector2d at = points.row(p).transpose();
    volume[p] = support.cut(width, Vector2d(frame.left, frame.floor) - at,
                            Vector2d(frame.right, frame.surface) - at);
  }
  const PointCells cells(points, first, last, width);
  const Eigen::MatrixX4d stress = grain_stresses(snapshot);
  for (std::size_t g = 0; g < snapshot.grains.size(); ++g) {
    const dem::Grain& grain = snapshot.grains[g];
    if (grain.fixed) continue;
    const Vector2d at = grain.position.head<2>(), reach = Vector2d::Constant(width);
    cells.near(at - reach, at + reach, [&](Eigen::Index p) {
      if (volume[p] <= 0 || !support.holds(at - points.row(p).transpose(), width)) return;
      const double weight = 1 / volume[p];
      add_grain(snapshot, grain, weight, p, sums);
      sums.row(p).head<4>() += weight * stress.row(static_cast<Eigen::Index>(g));
    });
  }
  for (Eigen::Index p = first; p < last; ++p)
    if (volume[p] < least_share * support.area(width))
      sums.row(p).head<kGrains>().setConstant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace grainfield::coupling
