// Places across the boundaries of a periodic cell.
#pragma once
#include <array>

#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// What lies more edges of the cell away is refused: nearest_image and wrapped throw
/// std::invalid_argument saying how many.
inline constexpr int kMostImages = 1'000'000;

/// From a place to its image, m; axes that are not periodic count nothing.
Vec3 shift_to(const Cell<3>& cell, const std::array<int, 3>& image);
/// The image n for which `branch` + edges n is shortest; of several the first.
std::array<int, 3> nearest_image(const Cell<3>& cell, const Vec3& branch);
/// The image of `place` whose coordinates along the periodic edges, from `low`, are within 0 and 1
/// (seen across the axes that are not periodic); itself where it is there already.
Vec3 wrapped(const Cell<3>& cell, const Vec3& place);

/// `image`, counted in the edges of `before`, in those of `after`: a cell that flows exchanges
/// whole edges when it slants too much (moving_cell.h). For one exchange between the two, and
/// strains below a half; a cell that has been strained further counts as not exchanged.
std::array<int, 3> image_in(const Cell<3>& after, const Cell<3>& before,
                            const std::array<int, 3>& image);
/// Where the second grain of a pair is, as the first one meets it, m.
inline Vec3 second_place(const Snapshot& s, const Contact& c) {
  const Vec3& place = s.grains[static_cast<std::size_t>(c.j)].position;
  const bool image = c.image[0] != 0 || c.image[1] != 0 || c.image[2] != 0;
  return image ? Vec3(place + shift_to(s.cell, c.image)) : place;
}

}  // namespace grainfield::dem
