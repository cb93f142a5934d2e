// The columns of a table of contacts.
#pragma once
#include <string>

#include "coupling/import/assemble.h"

namespace grainfield::coupling {

// Three columns of a vector; the third is needed in 3D only.
struct ColumnTriple {
  ForeignColumn x, y, z;
  explicit operator bool() const { return bool(x); }
  dem::Vec3 of(const ForeignRow& row) const {
    return {row.number(x), row.number(y), z ? row.number(z) : 0};
  }
};

inline ColumnTriple need_triple(const TableColumns& columns, const std::string& stem, int dim) {
  return {columns.need(stem + "x"), columns.need(stem + "y"),
          dim == 3 ? columns.need(stem + "z") : columns.find(stem + "z")};
}
inline ColumnTriple find_triple(const TableColumns& columns, const std::string& stem, int dim) {
  return columns.find(stem + "x") ? need_triple(columns, stem, dim) : ColumnTriple{};
}

struct Assembly::ContactColumns {
  ForeignColumn i, j, wall, friction, spring, sliding, fn, ft;
  CopyColumns copies;
  std::array<ColumnTriple, 2> line;  ///< the places of both bodies
  bool by_line = false;              ///< these tell the bodies
  bool of_meshes = false;            ///< and the ids are of something else
  ColumnTriple force, normal_part, tangential_part, point, normal, springs, tangent;
  /// Beside the whole force: what its parts are said to be.
  ForeignColumn told_fn, told_ft;
  ColumnTriple told_normal, told_tangential;
};

}  // namespace grainfield::coupling
