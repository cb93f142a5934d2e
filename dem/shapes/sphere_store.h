// Spheres as the engine keeps them: all is in the bodies.
#pragma once
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "dem/checkpoint/checkpoint.h"
#include "dem/shapes/solid.h"
#include "dem/space/body.h"
#include "dem/space/plane.h"
#include "dem/space/round_overlap.h"
#include "dem/space/space3.h"

namespace grainfield::dem {

/// With the contact point that round_overlap.h tells of.
class SphereStore {
 public:
  static constexpr int dim = 3;
  static constexpr bool outlines = false;
  static constexpr bool central = true;
  static constexpr bool keeps_places = false;
  static constexpr bool rows_in_lanes = true;  ///< whole pairs (laws/sphere_lanes.h)
  static constexpr bool offers(Measures m) {
    return m == Measures::depth || m == Measures::curvature || m == Measures::curvatures;
  }
  using Overlap = Overlap3;
  struct Feature {};

  Solid<3> add(const ShapeInput& shape) {
    if (!shape.outline.empty()) throw std::invalid_argument("a sphere has no outline");
    const double r = shape.radius, volume = 4.0 / 3 * std::numbers::pi * r * r * r;
    return {r, volume, Eigen::Vector3d::Constant(0.4 * volume * r * r)};
  }
  void place(int, const Body<3>&, const RotationOf<3>&) {}
  void swap(int, int) {}
  void sort(const std::vector<int>&) {}
  Outline outline(int) const { return {}; }

  template <Measures measures>
  bool overlap(int, const Body<3>& a, int, const Body<3>& b, Feature&, Overlap& o) const {
    const Eigen::Vector3d across = b.position - a.position;
    if (spheres_apart(across, a.radius, b.radius)) return false;
    const SpheresMeet<double> meet = spheres_meet(across, a.radius, b.radius, o);
    set_arms(meet.lever_i, meet.lever_j, o);
    if constexpr (measures == Measures::curvatures) set_curvatures(o);
    return true;
  }
  template <Measures measures>
  bool overlap_plane(int, const Body<3>& a, const Plane<3>& plane, Overlap& o) const {
    const double height = plane.height(a.position);
    if (height >= a.radius) return false;
    o.normal = -plane.normal;
    o.depth = a.radius - height;
    o.radius = a.radius;
    o.arm_i = -height * plane.normal;
    o.arm_j = Eigen::Vector3d::Zero();  // a wall does not turn
    if constexpr (measures == Measures::curvatures) set_curvatures(o);
    return true;
  }

  void write(CheckpointWriter&) const {}
  void read(CheckpointReader&, std::size_t) {}

 private:
  static void set_curvatures(Overlap& o) {
    o.lesser_curvature = o.greater_curvature = 0.5 / o.radius;
    o.major = o.normal.unitOrthogonal();
  }
};

}  // namespace grainfield::dem
