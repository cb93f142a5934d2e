// A field as a picture: a map of a grid in the plane, else profiles along its lines.
#pragma once
#include <string>

#include "coupling/field.h"
#include "coupling/report/picture.h"

namespace grainfield::coupling {

/// The column of that name; of an empty name the vertical stress, or the first one. Throws
/// std::invalid_argument with the names that are there.
const Column& drawn_column(const Field& field, const std::string& column);

/// A grid in the plane becomes a map of drawn_column(). Other points lie on lines along one axis:
/// profiles of the column, or where none is named of every stress that is there, normal ones as
/// pressures (-sigma_yy), with bars of the standard error. A field that was measured stands with
/// points, others with lines. Throws std::invalid_argument for points that lie on too many lines or
/// on none.
Picture field_picture(const std::string& title, const Field& field, const std::string& column);

}  // namespace grainfield::coupling
