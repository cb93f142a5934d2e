// Polygons (and disks among them) as the engine keeps them: corners in the body frame and where
// they are now, in blocks of equal length, in the order of the bodies.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "dem/checkpoint/checkpoint.h"
#include "dem/shapes/bounding_rectangle.h"
#include "dem/shapes/crossing_lanes.h"
#include "dem/shapes/place_lanes.h"
#include "dem/shapes/polygon.h"
#include "dem/shapes/solid.h"
#include "dem/space/aligned.h"
#include "dem/space/body.h"
#include "dem/space/plane.h"
#include "dem/space/rotation.h"

namespace grainfield::dem {

class PolygonStore {
 public:
  static constexpr int dim = 2;
  static constexpr bool outlines = true;
  static constexpr bool central = false;
  static constexpr bool keeps_places = true;
  static constexpr bool offers(Measures m) {
    return m != Measures::curvature && m != Measures::curvatures;
  }
  using Overlap = dem::Overlap;
  using Feature = PairFeature;

  Solid<2> add(const ShapeInput& shape) {
    const Outline& outline = shape.outline;
    const int n = static_cast<int>(outline.size());
    if (outline.size() + 1 > stride_) widen(n + 1);
    count_.push_back(n);
    most_corners_ = std::max(most_corners_, n);
    long_axis_.push_back(long_axis_of(outline));
    any_slender_ |= slender(static_cast<int>(count_.size()) - 1);
    corners_.resize(corners_.size() + kBlocks * stride_, 0.0);
    double* block = block_of(static_cast<int>(count_.size()) - 1);
    for (int k = 0; k <= n && n > 0; ++k) {
      block[k] = outline[k % n][0];
      block[stride_ + k] = outline[k % n][1];
    }
    Solid<2> solid = disk_solid(shape.radius);
    if (n > 0) solid = {circumradius_of(outline), area_of(outline), polar_moment_of(outline)};
    equal_radius_.push_back(n > 0 ? equal_radius(solid.volume) : shape.radius);
    return solid;
  }

  /// Turns and moves the corners to where the body is.
  void place(int i, const Body<2>& b, double angle) {
    const int n = count_[i];
    if (n == 0) return;
    double* block = block_of(i);
    const auto [c, s] = rotation_of(angle);
    const double *bx = block, *by = block + stride_;
    double *x = block + 2 * stride_, *y = block + 3 * stride_;
    const double cx = b.position.x(), cy = b.position.y();
    for (std::size_t k = 0; k < stride_; ++k) {
      x[k] = cx + (c * bx[k] - s * by[k]);
      y[k] = cy + (s * bx[k] + c * by[k]);
    }
  }

  /// The same for bodies list[0] to list[count - 1], side by side. `rotations`: of the first body,
  /// `step` numbers from one to the next.
  void place_all(const int* list, int count, const Body<2>* bodies, const double* rotations,
                 int step) {
    static_assert(sizeof(Body<2>) % sizeof(double) == 0);
    OutlineRows rows;
    rows.blocks = corners_.data();
    rows.block_size = kBlocks * stride_;
    rows.stride = static_cast<int>(stride_);
    rows.positions = bodies->position.data();
    rows.angles = rotations;
    rows.position_size = sizeof(Body<2>) / sizeof(double);
    rows.angle_size = step;
    place_outlines(rows, list, count);
  }

  /// Rows of the bodies' corners, for overlaps side by side.
  CrossingRows crossing_rows() const {
    CrossingRows rows;
    rows.blocks = corners_.data();
    rows.block_size = kBlocks * stride_;
    rows.stride = static_cast<int>(stride_);
    rows.most_corners = most_corners_;
    rows.corners = count_.data();
    return rows;
  }

  void swap(int i, int j) {
    std::swap(count_[i], count_[j]);
    std::swap(long_axis_[i], long_axis_[j]);
    std::swap(equal_radius_[i], equal_radius_[j]);
    std::swap_ranges(block_of(i), block_of(i) + kBlocks * stride_, block_of(j));
  }
  /// The first order.size() grains in this order.
  void sort(const std::vector<int>& order) {
    const std::size_t size = kBlocks * stride_;
    scratch_.resize(order.size() * size);
    counts_.resize(order.size());
    axes_.resize(order.size());
    radii_.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      const double* from = block_of(order[k]);
      std::copy(from, from + size, scratch_.begin() + static_cast<std::ptrdiff_t>(k * size));
      counts_[k] = count_[order[k]];
      axes_[k] = long_axis_[order[k]];
      radii_[k] = equal_radius_[order[k]];
    }
    std::copy(scratch_.begin(), scratch_.end(), corners_.begin());
    std::copy(counts_.begin(), counts_.end(), count_.begin());
    std::copy(axes_.begin(), axes_.end(), long_axis_.begin());
    std::copy(radii_.begin(), radii_.end(), equal_radius_.begin());
  }

  Outline outline(int i) const {
    Outline out;
    const double* block = block_of(i);
    for (int k = 0; k < count_[i]; ++k) out.push_back({block[k], block[stride_ + k]});
    return out;
  }

  PlacedShape placed(int i, const Body<2>& b) const {
    const double* block = block_of(i);
    return {block + 2 * stride_, block + 3 * stride_, count_[i],
            b.position.x(),      b.position.y(),      b.radius};
  }
  bool slender(int i) const { return long_axis_[i][0] != 0 || long_axis_[i][1] != 0; }
  bool any_slender() const { return any_slender_; }
  /// Where a slender grain's rectangle lies, or another's circle, with `gap` all round.
  BoundingRectangle bound(int i, const Body<2>& b, double angle, double gap) const {
    const auto [c, s] = rotation_of(angle);
    const auto [ux, uy] = long_axis_[i];
    return bounding_rectangle(placed(i, b), c * ux - s * uy, s * ux + c * uy, gap);
  }

  template <Measures measures>
  bool overlap(int i, const Body<2>& a, int j, const Body<2>& b, Feature& feature,
               Overlap& o) const {
    const double dx = b.position.x() - a.position.x(), dy = b.position.y() - a.position.y();
    const double reach = a.radius + b.radius;
    if (dx * dx + dy * dy >= reach * reach) return false;
    return found<measures>(i, j,
                           overlap_of_shapes(placed(i, a), placed(j, b), feature, o, measures), o);
  }
  /// The same with an image of j: b, and its corners `shift` away from where they are kept.
  template <Measures measures>
  bool overlap_image(int i, const Body<2>& a, int j, const Body<2>& b, const VectorOf<2>& shift,
                     Feature& feature, Overlap& o) const {
    const double dx = b.position.x() - a.position.x(), dy = b.position.y() - a.position.y();
    const double reach = a.radius + b.radius;
    if (dx * dx + dy * dy >= reach * reach) return false;
    PlacedShape image = placed(j, b);
    std::array<double, kMostCorners + 1> x, y;
    for (int k = 0; k <= image.n && image.n > 0; ++k) {
      x[k] = image.x[k] + shift.x();
      y[k] = image.y[k] + shift.y();
    }
    image.x = x.data();
    image.y = y.data();
    return found<measures>(i, j, overlap_of_shapes(placed(i, a), image, feature, o, measures), o);
  }
  template <Measures measures>
  bool overlap_plane(int i, const Body<2>& a, const Plane<2>& plane, Overlap& o) const {
    if (plane.height(a.position) >= a.radius) return false;
    if (!overlap_with_half_plane(placed(i, a), plane.point.x(), plane.point.y(), plane.normal.x(),
                                 plane.normal.y(), o, measures)) {
      return false;
    }
    if constexpr (measures == Measures::gradient) o.length = equal_radius_[i];
    return true;
  }

  void write(CheckpointWriter& w) const {
    w.put(stride_);
    w.put(count_);
    w.put(corners_);
    w.put(equal_radius_);
  }
  void read(CheckpointReader& r, std::size_t grains) {
    r.get(stride_);
    r.get(count_);
    r.get(corners_);
    r.get(equal_radius_);
    r.require(count_.size() == grains && equal_radius_.size() == grains &&
              corners_.size() == grains * kBlocks * stride_);
    most_corners_ = 0;
    for (const int n : count_) {
      r.require(n >= 0 && static_cast<std::size_t>(n) < stride_);
      most_corners_ = std::max(most_corners_, n);
    }
    long_axis_.clear();
    any_slender_ = false;
    for (int i = 0; i < static_cast<int>(grains); ++i) {
      long_axis_.push_back(long_axis_of(outline(i)));
      any_slender_ |= slender(i);
    }
  }

 private:
  static constexpr std::size_t kBlocks = 4;  // body x, body y, placed x, placed y

  template <Measures measures>
  bool found(int i, int j, bool touches, Overlap& o) const {
    if constexpr (measures == Measures::gradient) {
      if (touches) set_constant_length(equal_radius_[i], equal_radius_[j], o);
    }
    return touches;
  }
  double* block_of(int i) {
    return corners_.data() + static_cast<std::size_t>(i) * kBlocks * stride_;
  }
  const double* block_of(int i) const {
    return corners_.data() + static_cast<std::size_t>(i) * kBlocks * stride_;
  }
  void widen(int corners) {
    const std::size_t stride = static_cast<std::size_t>(corners + 3) / 4 * 4;
    LineVector<double> wide(count_.size() * kBlocks * stride, 0.0);
    for (std::size_t b = 0; b < count_.size() * kBlocks; ++b) {
      std::copy_n(corners_.begin() + static_cast<std::ptrdiff_t>(b * stride_), stride_,
                  wide.begin() + static_cast<std::ptrdiff_t>(b * stride));
    }
    corners_.swap(wide);
    stride_ = stride;
  }

  std::size_t stride_ = 4;
  int most_corners_ = 0;
  std::vector<int> count_, counts_;
  std::vector<std::array<double, 2>> long_axis_, axes_;  // in the body frame (long_axis_of)
  bool any_slender_ = false;
  std::vector<double> equal_radius_, radii_;  // of the circles of equal area, m
  LineVector<double> corners_, scratch_;
};

}  // namespace grainfield::dem
