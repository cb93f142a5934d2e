#include "coupling/averaging/base_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct Reach {
  Vector2d low, high;

  bool holds(const Vector3d& p) const {
    return p.x() >= low.x() && p.x() <= high.x() && p.y() >= low.y() && p.y() <= high.y();
  }
};

// Those with their images that are inside.
std::vector<BaseSupport> supports_within(const dem::Snapshot& snapshot, const Reach& inside) {
  const dem::Cell<3>& cell = snapshot.cell;
  std::array<int, 2> most{};
  for (int a = 0; a < 2; ++a) {
    if (!cell.periodic[a]) continue;
    const double away =
        std::max(std::fabs(inside.low[a] - cell.low[a]), std::fabs(inside.high[a] - cell.low[a]));
    most[a] = 1 + static_cast<int>(std::ceil(away / cell.edges(a, a)));
  }
  const std::vector<BaseSupport> own = base_supports(snapshot);
  std::vector<BaseSupport> out;
  for (int i = -most[0]; i <= most[0]; ++i) {
    for (int j = -most[1]; j <= most[1]; ++j) {
      const Vector3d shift = dem::shift_to(cell, {i, j, 0});
      for (const BaseSupport& s : own) {
        if (inside.holds(s.point + shift)) out.push_back({s.point + shift, s.force});
      }
    }
  }
  return out;
}

}  // namespace

double seen_from_above(const Kernel& kernel, double d) {
  const double half = kernel.range() * kernel.range() - d * d;
  return half > 0 ? kernel.along_line(d, -std::sqrt(half), std::sqrt(half)) : 0;
}

Field base_stress(const dem::Snapshot& snapshot, const Eigen::MatrixXd& places,
                  const Kernel& kernel) {
  if (snapshot.dim != 3 || kernel.dim() != 3)
    throw std::invalid_argument("stress on the base in space: a packing or a kernel of the plane");
  if (!has_base(snapshot))
    throw std::invalid_argument(
        "stress on the base: the packing has neither fixed grains nor a wall named \"floor\"");
  Field field;
  field.points.resize(places.rows(), 3);
  field.points.leftCols(2) = places;
  field.points.col(2).setConstant(layer_frame(snapshot).floor);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(places.rows(), 4);
  if (places.rows() > 0) {
    const double range = kernel.range();
    const Reach reach{places.colwise().minCoeff().transpose().array() - range,
                      places.colwise().maxCoeff().transpose().array() + range};
    for (const BaseSupport& s : supports_within(snapshot, reach)) {
      for (Index p = 0; p < places.rows(); ++p) {
        const double dx = places(p, 0) - s.point.x(), dy = places(p, 1) - s.point.y();
        const double squared = dx * dx + dy * dy;
        if (squared >= range * range) continue;
        const double weight = seen_from_above(kernel, std::sqrt(squared));
        sums.row(p) += Eigen::RowVector4d(-weight * s.force.z(), -weight * s.force.x(),
                                          -weight * s.force.y(), 1);
      }
    }
  }
  field.add("sigma_zz", "N/m2").value = sums.col(0);
  field.add("sigma_xz", "N/m2").value = sums.col(1);
  field.add("sigma_yz", "N/m2").value = sums.col(2);
  field.add("contacts", "1").value = sums.col(3);
  field.attributes = {
      {"what", "stress on the base"}, {"kernel", kernel.name()}, {"sign", "tension positive"}};
  return field;
}

Field base_stress_response(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
                           const Eigen::MatrixXd& places, const Kernel& kernel) {
  require_same_grains(unloaded, loaded);
  Field change = change_between(base_stress(unloaded, places, kernel),
                                base_stress(loaded, places, kernel), "contacts");
  change.attributes["what"] = "stress on the base, loaded - unloaded";
  return change;
}

RingPlaces ring_places(const Vector2d& axis, const Eigen::VectorXd& radii, double spacing) {
  RingPlaces out;
  Index all = 0;
  for (const double r : radii) {
    const double round = 2 * std::numbers::pi * r;
    out.count.push_back(std::max<Index>(8, static_cast<Index>(std::ceil(round / spacing))));
    all += out.count.back();
  }
  out.places.resize(all, 2);
  Index at = 0;
  for (Index k = 0; k < radii.size(); ++k) {
    const Index count = out.count[static_cast<std::size_t>(k)];
    for (Index p = 0; p < count; ++p) {
      const double angle =
          2 * std::numbers::pi * static_cast<double>(p) / static_cast<double>(count);
      out.places.row(at++) << axis.x() + radii[k] * std::cos(angle),
          axis.y() + radii[k] * std::sin(angle);
    }
  }
  return out;
}

Eigen::VectorXd ring_means(const RingPlaces& rings, const Eigen::VectorXd& values) {
  Eigen::VectorXd out(static_cast<Index>(rings.count.size()));
  Index at = 0;
  for (Index k = 0; k < out.size(); ++k) {
    const Index count = rings.count[static_cast<std::size_t>(k)];
    out[k] = values.segment(at, count).mean();
    at += count;
  }
  return out;
}

}  // namespace grainfield::coupling
