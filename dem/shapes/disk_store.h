// Disks as the engine keeps them: all is in the bodies.
#pragma once
#include <stdexcept>
#include <vector>

#include "dem/image/image.h"
#include "dem/shapes/disk.h"
#include "dem/shapes/polygon.h"
#include "dem/space/body.h"

namespace grainfield::dem {

class DiskStore {
 public:
  static constexpr bool outlines = false;

  void add(const Outline& outline) {
    if (!outline.empty()) {
      throw std::invalid_argument("a grain with an outline needs EngineSettings::polygons");
    }
  }
  void place(int, const Body&, double) {}
  void swap(int, int) {}
  void sort(const std::vector<int>&) {}
  Outline outline(int) const { return {}; }

  template <bool with_area>
  bool overlap(int, const Body& a, int, const Body& b, PairFeature&, Overlap& o) const {
    return overlap_of_disks<with_area>(b.x - a.x, b.y - a.y, a.radius, b.radius, o);
  }
  /// (px, py) on the plane, (wx, wy) its outward normal.
  template <bool with_area>
  bool overlap_plane(int, const Body& a, double px, double py, double wx, double wy,
                     Overlap& o) const {
    return overlap_with_plane<with_area>((a.x - px) * wx + (a.y - py) * wy, a.radius, wx, wy, o);
  }

  void write(ImageWriter&) const {}
  void read(ImageReader&, std::size_t) {}
};

}  // namespace grainfield::dem
