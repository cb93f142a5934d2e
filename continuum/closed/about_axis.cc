#include "continuum/closed/about_axis.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace grainfield::continuum {
namespace {

using Eigen::Index;

// Nodes of a panel along the radius and along the depth. A panel's ends are half its width from its
// middle and the singularity twice that, so errors fall by 2 + sqrt 5 = 4.2 a node, to 4.2^-24 =
// 1e-15; along the depth, where it is three half widths off, by 3 + sqrt 8 = 5.8, to 1e-17.
constexpr Index kAlongRadius = 24, kAlongDepth = 22;

/// Chebyshev's points of the first kind on [low, high].
Eigen::ArrayXd nodes(Index count, double low, double high) {
  const double step = std::numbers::pi / (2 * static_cast<double>(count));
  const Eigen::ArrayXd angle = Eigen::ArrayXd::LinSpaced(count, step, std::numbers::pi - step);
  return 0.5 * (low + high) - 0.5 * (high - low) * angle.cos();
}

/// Shares of the nodes' values in the interpolant at x: barycentric, with the weights
/// (-1)^k sin((2k+1) pi / 2n).
Eigen::VectorXd shares(const Eigen::ArrayXd& at, double x) {
  const Index n = at.size();
  Eigen::VectorXd out(n);
  for (Index k = 0; k < n; ++k) {
    if (x == at[k]) return Eigen::VectorXd::Unit(n, k);
    const double weight = std::sin((2 * static_cast<double>(k) + 1) * std::numbers::pi /
                                   (2 * static_cast<double>(n)));
    out[k] = (k % 2 == 0 ? weight : -weight) / (x - at[k]);
  }
  return out / out.sum();
}

}  // namespace

Eigen::ArrayX4d about_axis(const FieldAboutAxis& field, double panel, const Eigen::ArrayXd& radius,
                           const Eigen::ArrayXd& depth) {
  const double most = radius.size() > 0 ? radius.maxCoeff() : 0;
  const auto panels = static_cast<Index>(std::max(1.0, std::ceil(most / panel)));
  if (panels * kAlongRadius * kAlongDepth >= radius.size()) return field(radius, depth);
  const double width = most / static_cast<double>(panels);
  std::vector<std::vector<Index>> within(static_cast<std::size_t>(panels));
  for (Index k = 0; k < radius.size(); ++k) {
    const auto p = static_cast<Index>(radius[k] / width);
    within[static_cast<std::size_t>(std::min(p, panels - 1))].push_back(k);
  }
  const Eigen::ArrayXd depths = nodes(kAlongDepth, 0, 1);
  Eigen::ArrayX4d out(radius.size(), 4);
  for (Index p = 0; p < panels; ++p) {
    const std::vector<Index>& places = within[static_cast<std::size_t>(p)];
    if (places.empty()) continue;
    const Eigen::ArrayXd radii =
        nodes(kAlongRadius, static_cast<double>(p) * width, static_cast<double>(p + 1) * width);
    const Eigen::ArrayX4d values = field(radii.replicate(kAlongDepth, 1),
                                         depths.transpose().replicate(kAlongRadius, 1).reshaped());
    for (const Index k : places) {
      const Eigen::VectorXd along = shares(radii, radius[k]), down = shares(depths, depth[k]);
      for (Index c = 0; c < 4; ++c) {
        const Eigen::Map<const Eigen::Matrix<double, kAlongRadius, kAlongDepth>> grid(
            values.col(c).data());
        out(k, c) = along.dot(grid * down);
      }
    }
  }
  return out;
}

}  // namespace grainfield::continuum
