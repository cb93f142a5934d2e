// A field as a VTK unstructured grid (ASCII .vtu).
#pragma once
#include <string>

#include "coupling/field.h"

namespace grainfield::coupling {

/// Every column, and COLUMN_error where there are errors, at the points: quadrilaterals of a grid
/// in the plane, hexahedra of one in space, single points else. nan stays nan.
std::string field_vtu(const Field& field);

}  // namespace grainfield::coupling
