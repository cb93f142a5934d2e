// Superellipsoids as the engine keeps them: their shapes, and how they are turned.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
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
    // dh = |(x cross n) . turn|, |x cross n|^2 = x^2 - h^2.
    grain.lever =
        std::sqrt(std::max(grain.farthest * grain.farthest - grain.nearest * grain.nearest, 0.0));
    grain.equal_radius = cube_root(solid.volume / (4.0 / 3 * std::numbers::pi));
    grains_.push_back(grain);
    return solid;
  }
  void place(int i, const Body<3>&, const RotationOf<3>& rotation) {
    Grain& grain = grains_[i];
    const double chord =
        std::sqrt(std::min((rotation.coeffs() - grain.rotation.coeffs()).squaredNorm(),
                           (rotation.coeffs() + grain.rotation.coeffs()).squaredNorm()));
    // The angle is 4 asin(chord/2), and asin x <= x + (pi/2 - 1) x^3.
    grain.swept += grain.lever * 2 * chord * (1 + 0.15 * chord * chord);
    grain.rotation = rotation;
    grain.turn = rotation.toRotationMatrix();
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
    const double swept = first.swept + second.swept;
    if (across.dot(feature.normal) > feature.clear + swept) return false;
    constexpr bool curvatures = measures == Measures::curvatures;
    CommonNormal contact;
    if (!common_normal(turned(first), turned(second), across, feature, contact, curvatures)) {
      // Of a search that ended exactly in touch nothing is known along the normal that it left.
      feature.clear = contact.depth < 0 ? across.dot(feature.normal) + contact.depth - swept
                                        : std::numeric_limits<double>::infinity();
      return false;
    }
    feature.clear = std::numeric_limits<double>::infinity();
    o.normal = contact.normal;
    o.depth = contact.depth;
    o.arm_i = contact.point;
    o.arm_j = contact.point - across;
    if constexpr (curvatures) {
      o.radius =
          first.equal_radius * second.equal_radius / (first.equal_radius + second.equal_radius);
      o.lesser_curvature = contact.lesser_curvature;
      o.greater_curvature = contact.greater_curvature;
      o.major = contact.major;
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
    const Support s = support_of(grain.shape, in_body);
    if (s.height <= height) return false;
    o.normal = n;
    o.depth = s.height - height;
    o.arm_i = grain.turn * s.point - 0.5 * o.depth * n;
    o.arm_j = Eigen::Vector3d::Zero();  // a wall does not turn
    if constexpr (measures == Measures::curvatures) {
      const Tangents tangents = tangents_of(n);
      const Bend bend = bend_of(s, turned(grain).in_body(tangents));
      const PlanePrincipal relative = relative_curvatures(bend);
      o.radius = grain.equal_radius;
      o.lesser_curvature = relative.lesser;
      o.greater_curvature = relative.greater;
      o.major = across_of(relative, tangents);
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
    double lever = 0;  ///< by how much the height of any normal changes a radian at most, m
    double swept = 0;  ///< and what it may have changed by so far, m
    RotationOf<3> rotation = RotationOf<3>::Identity();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  };

  static Superellipsoid shape_of(const ShapeInput& input) {
    return dem::superellipsoid(input.axes, input.exponents);
  }
  static TurnedBody turned(const Grain& grain) {
    return {grain.shape, grain.turn, grain.farthest, grain.nearest};
  }

  std::vector<Grain> grains_;
};

}  // namespace grainfield::dem
