// A picture as the bytes of an image.
#pragma once
#include "coupling/report/gnuplot.h"
#include "coupling/report/picture.h"

namespace grainfield::coupling {

/// As PNG (`bitmap`, at twice the picture's size, for sharp lines on dense screens) or SVG.
Drawing draw_picture(const std::string& gnuplot, const Picture& picture, bool bitmap);

}  // namespace grainfield::coupling
