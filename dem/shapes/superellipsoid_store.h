// Superellipsoids as the engine keeps them: their shapes, and how they are turned.
#pragma once
#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "dem/image/image.h"
#include "dem/shapes/common_normal.h"
#include "dem/shapes/solid.h"
#include "dem/space/body.h"
#include "dem/space/elementary.h"
#include "dem/space/overlap.h"
#include "dem/space/plane.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

class SuperellipsoidStore {
 public:
  static constexpr int dim = 3;
  static constexpr bool outlines = false;
  static constexpr bool central = false;
  static constexpr bool keeps_places = true;
  static constexpr bool offers(Measures m) {
    return m == Measures::depth || m == Measures::curvatures;
  }
  using Overlap = Overlap3;
  using Feature = PairNormal;

  /// Bounding radius of what is given, m. Throws std::invalid_argument as `superellipsoid` does.
  static double reach(const ShapeInput& shape) { return farthest_of(shape_of(shape)); }

  Solid<3> add(const ShapeInput& input) {
    Grain grain;
    grain.shape = shape_of(input);
    const Solid<3> solid = solid_of(grain.shape);
    grain.farthest = solid.radius;
    grain.nearest = nearest_of(grain.shape);
    grain.equal_radius = cube_root(solid.volume / (4.0 / 3 * std::numbers::pi));
    grains_.push_back(grain);
    return solid;
  }
  void place(int i, const Body<3>&, const RotationOf<3>& rotation) {
    grains_[i].turn = rotation.toRotationMatrix();
  }
  void swap(int i, int j) { std::swap(grains_[i], grains_[j]); }
  void sort(const std::vector<int>& order) {
    std::vector<Grain> sorted(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = grains_[order[k]];
    std::copy(sorted.begin(), sorted.end(), grains_.begin());
  }
  Outline outline(int) const { return {}; }
  const Superellipsoid& superellipsoid(int i) const { return grains_[i].shape; }

  template <Measures measures>
  bool overlap(int i, const Body<3>& a, int j, const Body<3>& b, Feature& feature,
               Overlap& o) const {
    const Grain &first = grains_[i], &second = grains_[j];
    const Eigen::Vector3d across = b.position - a.position;
    CommonNormal contact;
    if (!common_normal(turned(first), turned(second), across, feature, contact)) return false;
    o.normal = contact.normal;
    o.depth = contact.depth;
    o.arm_i = contact.point;
    o.arm_j = contact.point - across;
    if constexpr (measures == Measures::curvatures) {
      set_curvatures(
          first.equal_radius * second.equal_radius / (first.equal_radius + second.equal_radius),
          relative_curvatures(contact.normal, contact.bend.data(), 4), o);
    }
    return true;
  }
  /// The contact point is in the middle between the surface and the plane.
  template <Measures measures>
  bool overlap_plane(int i, const Body<3>& a, const Plane<3>& plane, Overlap& o) const {
    const double height = plane.height(a.position);
    if (height >= a.radius) return false;
    const Grain& grain = grains_[i];
    const Eigen::Vector3d n = -plane.normal, in_body = grain.turn.transpose() * n;
    if (height_of(grain.shape, in_body) <= height) return false;
    const Support s = support_of(grain.shape, in_body);
    o.normal = n;
    o.depth = s.height - height;
    o.arm_i = grain.turn * s.point - 0.5 * o.depth * n;
    o.arm_j = Eigen::Vector3d::Zero();  // a wall does not turn
    if constexpr (measures == Measures::curvatures) {
      Principal relative = relative_curvatures(in_body, s.bend.data(), 2);
      relative.along = grain.turn * relative.along;
      set_curvatures(grain.equal_radius, relative, o);
    }
    return true;
  }

  void write(ImageWriter& w) const { w.put(grains_); }
  void read(ImageReader& r, std::size_t grains) {
    r.get(grains_);
    r.require(grains_.size() == grains);
  }

 private:
  struct Grain {
    Superellipsoid shape;
    double farthest = 0, nearest = 0;  ///< points of the surface from the centre, m
    double equal_radius = 0;           ///< of the sphere of equal volume, m
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  };

  static Superellipsoid shape_of(const ShapeInput& input) {
    return dem::superellipsoid(input.axes, input.exponents);
  }
  static TurnedBody turned(const Grain& grain) {
    return {grain.shape, grain.turn, grain.farthest, grain.nearest};
  }
  static void set_curvatures(double radius, const Principal& relative, Overlap& o) {
    o.radius = radius;
    o.greater_curvature = relative.greater;
    o.lesser_curvature = relative.lesser;
    o.major = o.normal.cross(relative.along);
  }

  std::vector<Grain> grains_;
};

}  // namespace grainfield::dem
