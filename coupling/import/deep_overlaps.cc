#include "coupling/import/deep_overlaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dem/neighbours/hierarchical_grid.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

constexpr double kDeep = 0.5;  // of the smaller radius
constexpr long long kMost =
    10'000;  // pairs: of a very narrow period there are more than fit memory
// Side of the searched box about the middle, mean radii times the D-th root of the number of
// grains: few grains far from all others would make the search slow.
constexpr double kSide = 30;

template <int D>
dem::PlainVector<D> part_of(const dem::Vec3& v) {
  return v.head<D>();
}

struct Found {
  long long count = 0;
  std::int64_t i = 0, j = 0;
};

// Round grains near the middle; `index`: their places in the packing.
template <int D>
std::vector<dem::Reach<D>> round_grains(const dem::Snapshot& s, std::vector<std::size_t>& index) {
  dem::Vec3 middle = dem::Vec3::Zero();
  double radius = 0;
  const auto n = static_cast<double>(s.grains.size());
  for (const dem::Grain& g : s.grains) {
    middle += g.position / n;
    radius += g.radius / n;
  }
  const double side = kSide * radius * std::pow(n, 1.0 / D);
  std::vector<dem::Reach<D>> out;
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    const dem::Grain& g = s.grains[k];
    if (!g.outline.empty() || !g.axes.isZero(0) ||
        (g.position - middle).cwiseAbs().maxCoeff() > side)
      continue;
    out.push_back({part_of<D>(g.position), g.radius, g.fixed});
    index.push_back(k);
  }
  return out;
}

template <int D>
Found search(const dem::Snapshot& s) {
  std::vector<std::size_t> index;
  const std::vector<dem::Reach<D>> grains = round_grains<D>(s, index);
  Found found;
  if (grains.empty()) return found;
  dem::HierarchicalGrid<D> grid;
  grid.build(grains);
  dem::PlainVector<D> low = grains.front().centre, high = low;
  double most = 0;
  for (const dem::Reach<D>& g : grains) {
    low = low.cwiseMin(g.centre);
    high = high.cwiseMax(g.centre);
    most = std::max(most, g.reach);
  }
  const auto reach = [&](std::size_t axis) { return s.cell.periodic[axis] ? 1 : 0; };
  std::vector<int> near;
  for (int a = -reach(0); a <= reach(0); ++a)
    for (int b = -reach(1); b <= reach(1); ++b)
      for (int c = -reach(2); c <= reach(2); ++c) {
        const std::array<int, 3> image{a, b, c};
        // One of an image and its opposite is enough.
        if (image < std::array<int, 3>{0, 0, 0}) continue;
        const bool home = image == std::array<int, 3>{0, 0, 0};
        const dem::PlainVector<D> shift = part_of<D>(dem::shift_to(s.cell, image));
        for (std::size_t k = 0; k < grains.size(); ++k) {
          dem::Reach<D> g = grains[k];
          g.centre += shift;
          if (((g.centre - low).array() < -2 * most).any() ||
              ((g.centre - high).array() > 2 * most).any())
            continue;
          near.clear();
          grid.near(g, near);
          for (const int other : near) {
            const auto l = static_cast<std::size_t>(other);
            const dem::Reach<D>& h = grains[l];
            if ((home && l <= k) || (g.fixed && h.fixed)) continue;
            const double overlap = g.reach + h.reach - (h.centre - g.centre).norm();
            if (!(overlap > kDeep * std::min(g.reach, h.reach))) continue;
            if (found.count++ == 0) {
              found.i = s.grains[index[k]].id;
              found.j = s.grains[index[l]].id;
            }
            if (found.count == kMost) return found;
          }
        }
      }
  return found;
}

}  // namespace

std::string deep_overlaps(const dem::Snapshot& s) {
  const Found found = s.dim == 2 ? search<2>(s) : search<3>(s);
  if (found.count == 0) return "";
  return fmt::format(
      "pairs of grains that overlap by more than half the smaller radius: {}{} (the first: {} and "
      "{}); are the radii diameters, or in another unit than the places{}?",
      found.count, found.count == kMost ? " or more" : "", found.i, found.j,
      s.cell.is_periodic() ? ", or is the period narrower than the packing" : "");
}

}  // namespace grainfield::coupling
