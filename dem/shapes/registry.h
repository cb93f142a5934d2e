// Every shape, by its word. A new one is a store beside this one, an entry in AnyShape and a line
// in a file of dem/engine that compiles the engine for it.
#pragma once
#include "dem/words/choice.h"

namespace grainfield::dem {

class DiskStore;
class PolygonStore;
class SphereStore;
class SuperellipsoidStore;

struct Disks {
  static constexpr const char* name = "disk";
  static constexpr int dim = 2;
  using Store = DiskStore;
};
/// Convex polygons, and disks among them.
struct Polygons {
  static constexpr const char* name = "polygon";
  static constexpr int dim = 2;
  using Store = PolygonStore;
};

struct Spheres {
  static constexpr const char* name = "sphere";
  static constexpr int dim = 3;
  using Store = SphereStore;
};

struct Superellipsoids {
  static constexpr const char* name = "superellipsoid";
  static constexpr int dim = 3;
  using Store = SuperellipsoidStore;
};

using AnyShape = std::variant<Disks, Polygons, Spheres, Superellipsoids>;

struct ShapeKind : Choice<AnyShape> {
  using Choice::Choice;
  static const ShapeKind disk, polygon, sphere, superellipsoid;
};
inline constexpr ShapeKind ShapeKind::disk{AnyShape(Disks{})};
inline constexpr ShapeKind ShapeKind::polygon{AnyShape(Polygons{})};
inline constexpr ShapeKind ShapeKind::sphere{AnyShape(Spheres{})};
inline constexpr ShapeKind ShapeKind::superellipsoid{AnyShape(Superellipsoids{})};

}  // namespace grainfield::dem
