// Every shape, by its word. A new one is a store beside this one, an entry in AnyShape and a line
// in a file of dem/engine that compiles the engine for it.
#pragma once
#include "dem/words/choice.h"

namespace grainfield::dem {

class DiskStore;
class PolygonStore;

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

using AnyShape = std::variant<Disks, Polygons>;

struct ShapeKind : Choice<AnyShape> {
  using Choice::Choice;
  static const ShapeKind disk, polygon;
};
inline constexpr ShapeKind ShapeKind::disk{AnyShape(Disks{})};
inline constexpr ShapeKind ShapeKind::polygon{AnyShape(Polygons{})};

}  // namespace grainfield::dem
