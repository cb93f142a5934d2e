// Compiled for every width (lanes.h): no function of it may be another file's, too.
#include "dem/shapes/place_lanes.h"

#include "dem/space/lane_angle.h"

namespace grainfield::dem {
namespace {

// Corners side by side: a stride is a multiple of 4.
constexpr int kCorners = GRAINFIELD_LANES < 4 ? GRAINFIELD_LANES : 4;

[[gnu::always_inline]] inline void place(double* block, int stride, double cx, double cy, double c,
                                         double s) {
  const double *bx = block, *by = block + stride;
  double *x = block + 2 * stride, *y = block + 3 * stride;
  for (int k = 0; k < stride; k += kCorners) {
    const Lanes<kCorners> px = loaded<kCorners>(bx + k), py = loaded<kCorners>(by + k);
    store<kCorners>(cx + (c * px - s * py), x + k);
    store<kCorners>(cy + (s * px + c * py), y + k);
  }
}

}  // namespace

template <int W>
void place_outlines_of(const OutlineRows& rows, const int* list, int count) {
  for (int at = 0; at < count; at += W) {
    const int left = count - at;
    const Angle<W> angle = angle_of<W>(lanes_of<W>([&](int k) {
      return rows.angles[std::ptrdiff_t{list[at + (k < left ? k : 0)]} * rows.angle_size];
    }));
    for (int k = 0; k < W && k < left; ++k) {
      const int i = list[at + k];
      const double* position = rows.positions + std::ptrdiff_t{i} * rows.position_size;
      place(rows.blocks + static_cast<std::size_t>(i) * rows.block_size, rows.stride, position[0],
            position[1], angle.cosine[k], angle.sine[k]);
    }
  }
}
template void place_outlines_of<GRAINFIELD_LANES>(const OutlineRows& rows, const int* list,
                                                  int count);

}  // namespace grainfield::dem
