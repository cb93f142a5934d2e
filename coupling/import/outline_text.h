// Outlines of polygons as text: "x1 y1;x2 y2;...".
#pragma once
#include <string>
#include <string_view>

#include "dem/space/outline.h"

namespace grainfield::coupling {

/// Corners, m; of numbers times 10^ten m. Throws std::invalid_argument saying which corner is no
/// pair of finite numbers.
dem::Outline parse_outline(std::string_view text, int ten = 0);

}  // namespace grainfield::coupling
