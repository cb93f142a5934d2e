#include "coupling/averaging/periodic.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

using Image = std::array<int, 3>;

// Copies of the cell beyond which points are taken for a mistake.
constexpr std::size_t kMostCells = 1000;
// Steps along an edge that are looked at: cells that are flatter are refused.
constexpr double kMostSteps = 200;

// The images whose grains come into the box of the points, each side `reach` wider.
std::vector<Image> images_near(const dem::Snapshot& s, const Eigen::MatrixXd& points,
                               double reach) {
  const auto refuse = [] {
    throw std::invalid_argument(
        "the points are too far from the periodic cell, or the averaging width is too large: more "
        "than a thousand images of it would be needed");
  };
  using Box = Eigen::AlignedBox3d;
  Box grains, wanted;
  for (const dem::Grain& g : s.grains) grains.extend(g.position);
  for (Eigen::Index p = 0; p < points.rows(); ++p) {
    dem::Vec3 at = dem::Vec3::Zero();
    at.head(s.dim) = points.row(p).transpose();
    wanted.extend(at);
  }
  if (grains.isEmpty() || wanted.isEmpty()) return {{0, 0, 0}};
  wanted.min().array() -= reach;
  wanted.max().array() += reach;
  Box both = grains;
  both.extend(wanted);
  // Distance of the cell's sides: so many steps reach everywhere.
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero();
  for (int a = 0; a < 3; ++a)
    if (s.cell.periodic[static_cast<std::size_t>(a)]) edges.col(a) = s.cell.edges.col(a);
  const Eigen::Matrix3d inverse = edges.completeOrthogonalDecomposition().pseudoInverse();
  Image most{0, 0, 0};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!s.cell.periodic[a]) continue;
    const double steps =
        std::ceil(both.diagonal().norm() * inverse.row(static_cast<Eigen::Index>(a)).norm());
    if (!(steps < kMostSteps)) refuse();
    most[a] = static_cast<int>(steps);
  }
  std::vector<Image> found;
  for (int i = -most[0]; i <= most[0]; ++i)
    for (int j = -most[1]; j <= most[1]; ++j)
      for (int k = -most[2]; k <= most[2]; ++k) {
        const Image image{i, j, k};
        const dem::Vec3 shift = dem::shift_to(s.cell, image);
        if (!wanted.intersects(Box(grains.min() + shift, grains.max() + shift))) continue;
        if (found.size() == kMostCells) refuse();
        found.push_back(image);
      }
  return found;
}

}  // namespace

Surrounded surround(const dem::Snapshot& s, const Eigen::MatrixXd& points, double reach) {
  Surrounded out;
  out.snapshot = s;
  out.snapshot.cell = {};
  out.snapshot.grains.clear();
  out.snapshot.contacts.clear();
  double largest = 0;
  for (const dem::Grain& g : s.grains) largest = std::max(largest, g.radius);
  std::map<std::pair<Image, std::int64_t>, std::int64_t> places;
  const auto place = [&](const Image& image, std::int64_t grain) {
    const auto [at, is_new] =
        places.try_emplace({image, grain}, static_cast<std::int64_t>(out.snapshot.grains.size()));
    if (is_new) {
      const dem::Vec3 shift = dem::shift_to(s.cell, image);
      dem::Grain copy = s.grains[static_cast<std::size_t>(grain)];
      copy.position += shift;
      copy.velocity += s.cell.velocity_gradient * shift;
      out.snapshot.grains.push_back(std::move(copy));
      out.source.push_back(static_cast<std::size_t>(grain));
    }
    return at->second;
  };
  // Two diameters more: branches end there, and the free surface is taken from columns so wide.
  for (const Image& image : images_near(s, points, reach + 8 * largest)) {
    for (std::size_t g = 0; g < s.grains.size(); ++g) place(image, static_cast<std::int64_t>(g));
    const dem::Vec3 shift = dem::shift_to(s.cell, image);
    for (dem::Contact c : s.contacts) {
      const Image across{image[0] + c.image[0], image[1] + c.image[1], image[2] + c.image[2]};
      c.i = place(image, c.i);
      if (c.j >= 0) c.j = place(across, c.j);
      c.point += shift;
      c.image = {0, 0, 0};
      out.snapshot.contacts.push_back(c);
    }
  }
  return out;
}

}  // namespace grainfield::coupling
