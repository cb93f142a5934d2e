// Contacts across a periodic side whose file gives the copy of the grain a number of its own
// (MercuryDPM). The row has all that tells the grain: the copy's centre lies its radius, less half
// the overlap, behind the contact point along the normal.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "coupling/import/assemble.h"
#include "dem/snapshot/images.h"

namespace grainfield::coupling {
namespace {

using dem::Vec3;

// Between the centre that a row tells and that of the grain, radii: six digits leave far less, and
// grains that touch are farther apart.
constexpr double kSameCentre = 0.02;

}  // namespace

void Assembly::sort_for_copies() {
  const auto& grains = out_.snapshot.grains;
  by_x_.resize(grains.size());
  std::iota(by_x_.begin(), by_x_.end(), std::int64_t{0});
  std::sort(by_x_.begin(), by_x_.end(), [&](std::int64_t a, std::int64_t b) {
    return grains[static_cast<std::size_t>(a)].position.x() <
           grains[static_cast<std::size_t>(b)].position.x();
  });
  const auto smaller = [](const dem::Grain& a, const dem::Grain& b) { return a.radius < b.radius; };
  const auto [least, most] = std::minmax_element(grains.begin(), grains.end(), smaller);
  least_radius_ = least->radius;
  largest_radius_ = most->radius;
}

std::vector<std::int64_t> Assembly::originals_of(const Vec3& point, const Vec3& outwards,
                                                 double overlap) const {
  const dem::Snapshot& s = out_.snapshot;
  const auto& grains = s.grains;
  std::vector<std::int64_t> found;
  const auto steps = [&](std::size_t axis) { return s.cell.periodic[axis] ? 1 : 0; };
  for (int a = -steps(0); a <= steps(0); ++a)
    for (int b = -steps(1); b <= steps(1); ++b)
      for (int c = -steps(2); c <= steps(2); ++c) {
        if (a == 0 && b == 0 && c == 0) continue;
        const Vec3 near = point + dem::shift_to(s.cell, {a, b, c});
        const auto centre = [&](double radius) {
          return Vec3(near + (radius - overlap / 2) * outwards);
        };
        const double ends[] = {centre(least_radius_).x(), centre(largest_radius_).x()};
        const double margin = kSameCentre * largest_radius_;
        const auto first = std::partition_point(by_x_.begin(), by_x_.end(), [&](std::int64_t k) {
          return grains[static_cast<std::size_t>(k)].position.x() <
                 std::min(ends[0], ends[1]) - margin;
        });
        for (auto at = first; at != by_x_.end(); ++at) {
          const dem::Grain& g = grains[static_cast<std::size_t>(*at)];
          if (g.position.x() > std::max(ends[0], ends[1]) + margin) break;
          if ((centre(g.radius) - g.position).norm() <= kSameCentre * g.radius)
            found.push_back(*at);
        }
      }
  return found;
}

std::int64_t Assembly::original_of(const ForeignRow& row, const CopyColumns& columns,
                                   std::int64_t copy, bool copy_is_first) const {
  const dem::Snapshot& s = out_.snapshot;
  if (!s.cell.is_periodic())
    row.refuse(
        fmt::format("contact of the unknown grain {}; {}; numbers beyond those of the grains are "
                    "copies across a "
                    "periodic side: --periodic AXIS=LOW:HIGH says where",
                    copy, known_grains()));
  const auto vector = [&](const std::array<ForeignColumn, 3>& of) {
    return Vec3(row.number(of[0]), row.number(of[1]), s.dim == 3 ? row.number(of[2]) : 0);
  };
  // The normal points to the first of the two.
  const Vec3 outwards = (copy_is_first ? 1 : -1) * vector(columns.normal);
  const auto found = originals_of(vector(columns.point), outwards, row.number(columns.overlap));
  if (found.size() == 1) return found.front();
  if (found.empty())
    row.refuse(fmt::format(
        "contact with {}, a copy across a periodic side: no grain has a copy at its contact point, "
        "allowed: sides of --periodic as in the simulation",
        copy));
  row.refuse(
      fmt::format("contact with {}, a copy across a periodic side: it may be of grain {} or {}, "
                  "allowed: one (more "
                  "digits, or a packing without grains in one place)",
                  copy, s.grains[static_cast<std::size_t>(found[0])].id,
                  s.grains[static_cast<std::size_t>(found[1])].id));
}

}  // namespace grainfield::coupling
