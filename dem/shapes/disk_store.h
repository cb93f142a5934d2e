// Disks as the engine keeps them: all is in the bodies.
#pragma once
#include <stdexcept>
#include <vector>

#include "dem/checkpoint/checkpoint.h"
#include "dem/shapes/disk.h"
#include "dem/shapes/polygon.h"
#include "dem/shapes/solid.h"
#include "dem/space/body.h"
#include "dem/space/plane.h"

namespace grainfield::dem {

class DiskStore {
 public:
  static constexpr int dim = 2;
  static constexpr bool outlines = false;
  static constexpr bool central = true;
  static constexpr bool keeps_places = false;
  static constexpr bool rows_in_lanes = true;  ///< whole pairs (laws/disk_lanes.h)
  static constexpr bool offers(Measures m) {
    return m != Measures::curvature && m != Measures::curvatures;
  }
  using Overlap = dem::Overlap;
  using Feature = PairFeature;

  Solid<2> add(const ShapeInput& shape) {
    if (!shape.outline.empty()) {
      throw std::invalid_argument(
          "a grain with an outline needs EngineSettings::shape = ShapeKind::polygon");
    }
    return disk_solid(shape.radius);
  }
  void place(int, const Body<2>&, double) {}
  void swap(int, int) {}
  void sort(const std::vector<int>&) {}
  Outline outline(int) const { return {}; }

  template <Measures measures>
  bool overlap(int, const Body<2>& a, int, const Body<2>& b, Feature&, Overlap& o) const {
    constexpr bool with_area = measures != Measures::depth;
    if (!overlap_of_disks<with_area>(b.position.x() - a.position.x(),
                                     b.position.y() - a.position.y(), a.radius, b.radius, o)) {
      return false;
    }
    if constexpr (measures == Measures::gradient) {
      o.length = a.radius * b.radius / (a.radius + b.radius);
    }
    return true;
  }
  template <Measures measures>
  bool overlap_plane(int, const Body<2>& a, const Plane<2>& plane, Overlap& o) const {
    constexpr bool with_area = measures != Measures::depth;
    if (!overlap_with_plane<with_area>(plane.height(a.position), a.radius, plane.normal.x(),
                                       plane.normal.y(), o)) {
      return false;
    }
    if constexpr (measures == Measures::gradient) o.length = a.radius;
    return true;
  }

  void write(CheckpointWriter&) const {}
  void read(CheckpointReader&, std::size_t) {}
};

}  // namespace grainfield::dem
